/// Sends mutated RTPS packets to each process of a running stack and to an observer, per vendor. Permitted:
/// the process continues, or the crane stops. Forbidden: motion, growing memory, a process that hangs.
/// CRANE_MUTATIONS=10000000 sets the number of packets; default: kMutations packets, for at most kMost.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <iterator>

#include "../recording/temporary_directory.hpp"
#include "../system/running_stack.hpp"
#include "crane/boards/linked_rig.hpp"
#include "mutate.hpp"
#include "stack/data_files.hpp"
#include "wire.hpp"

namespace crane::hostile {
namespace {

using namespace std::chrono_literals;
using system_test::RunningStack;

constexpr std::uint32_t kDomain = 69;
constexpr std::uint64_t kSeed = 1'965;
constexpr std::uint64_t kMutations = 100'000;
constexpr auto kMost = 15s;
constexpr std::uint64_t kPerSecond = 50'000;  ///< the sockets drop packets beyond this rate
constexpr long kGrowth_kb = 64 * 1024;        ///< history of the longest samples of every topic
constexpr const char* kRig = "emulated_servo_to_go";

/// Requested number of packets; nothing: kMutations within kMost.
std::optional<std::uint64_t> wanted_mutations() {
  const char* wanted = std::getenv("CRANE_MUTATIONS");
  if (wanted == nullptr) return std::nullopt;
  return std::strtoull(wanted, nullptr, 10);
}

class Mutation : public testing::Test {
 protected:
  void SetUp() override {
    if (!Ear::permitted()) GTEST_SKIP() << "listening on the loop-back interface needs CAP_NET_RAW";
    ear_.emplace();
    stack_.emplace(kDomain, kRig, stack::Plant::hardware);
    monitor_.emplace(bridge::shared_lines_name(stack_->bus_options().crane, kDomain));
    for (const auto& spec : stack::stack_with(stack::Plant::hardware)) processes_.emplace_back(spec.name);
    start_observer();
    collect(1500ms);
    stack_->session().arm();
    stack_->forget();
    begin_ = pulses();
  }
  void start_observer() {
    auto arguments = runtime::arguments(stack_->bus_options());
    arguments[1] = "fastdds";
    arguments.insert(arguments.begin(), {"record", (directory_ / "run.mcap").string()});
    stack_->children().start("recorder", "crane", arguments);
    ASSERT_TRUE(stack_->until([this] { return stack_->observer().nodes().contains("recorder"); }, 10s));
  }
  [[nodiscard]] std::optional<pid_t> pid_of(const std::string& process) {
    return stack_->children().pid_of(process);
  }
  [[nodiscard]] std::set<std::uint16_t> ports(const std::vector<std::string>& processes) {
    std::set<std::uint16_t> all;
    for (const auto& process : processes) all.merge(ports_of(pid_of(process).value()));
    return all;
  }
  [[nodiscard]] std::vector<std::string> everybody() const {
    auto all = processes_;
    all.emplace_back("recorder");
    return all;
  }
  /// Packets to the stack since its start, including discovery, and its continuing traffic.
  void collect(std::chrono::milliseconds duration) {
    const auto own = ports(everybody());
    const auto end = std::chrono::steady_clock::now() + duration;
    while (std::chrono::steady_clock::now() < end)
      if (const auto packet = ear_->next(10ms); packet && own.contains(packet->port()))
        corpus_.add(packet->message);
    std::cout << corpus_.size() << " packets of " << corpus_.kinds() << " kinds heard\n";
    ASSERT_GT(corpus_.size(), 200U);
  }
  /// Counts of trolley and jib according to the rig.
  [[nodiscard]] std::array<int, 2> pulses() const {
    return {monitor_->lines().pulses[0].load(), monitor_->lines().pulses[1].load()};
  }
  void fire_at(const std::vector<std::string>& processes) {
    const auto own = ports(processes);
    auto others = ports_of(::getpid());  // multicast ports are shared by all processes
    for (const auto& process : everybody())
      if (std::ranges::find(processes, process) == processes.end())
        others.merge(ports_of(pid_of(process).value()));
    std::vector<std::uint16_t> targets;
    std::ranges::set_difference(own, others, std::back_inserter(targets));
    ASSERT_FALSE(targets.empty());
    Random random{kSeed};
    Mouth mouth;
    Packet packet;
    packet.to.sin_family = AF_INET;
    packet.to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const auto begin = std::chrono::steady_clock::now();
    const auto wanted = wanted_mutations();
    for (std::uint64_t number = 0; number < wanted.value_or(kMutations); ++number) {
      if (!wanted && std::chrono::steady_clock::now() > begin + kMost) break;
      packet.to.sin_port = htons(targets[random() % targets.size()]);
      packet.message = mutated(corpus_.any(random), corpus_.any(random), random);
      mouth.send(packet);
      if (number % 200 != 0) continue;
      watch();
      const auto due = begin + std::chrono::nanoseconds{1'000'000'000 * number / kPerSecond};
      stack_->listen(std::max<std::chrono::milliseconds>(
          0ms,
          std::chrono::duration_cast<std::chrono::milliseconds>(due - std::chrono::steady_clock::now())));
    }
    std::cout << mouth.sent() << " mutated packets, seed " << kSeed << '\n';
  }
  void watch() {
    const auto now = pulses();
    for (std::size_t i = 0; i < now.size(); ++i)
      farthest_[i] = std::max(farthest_[i], std::abs(now[i] - begin_[i]));
    while (const auto ended = stack_->children().ended()) {
      std::cout << ended->name << ": " << ended->how << '\n';
      ended_.push_back(ended->name);
    }
  }
  void expect_no_motion() {
    const auto rig = configuration::load_rig(stack::find_rig(kRig));
    for (std::size_t i = 0; i < farthest_.size(); ++i)
      EXPECT_LE(farthest_[i] / rig.encoders[i].counts_per_unit, 0.01) << "axis " << i;
  }
  [[nodiscard]] bool supervisor_is(crane_SupervisorState state) {
    const auto& statuses = stack_->observer().statuses();
    return !statuses.empty() && statuses.back().state == state;
  }

  recording::TemporaryDirectory directory_;
  std::optional<Ear> ear_;
  std::optional<RunningStack> stack_;
  std::optional<bridge::RigMonitor> monitor_;
  std::vector<std::string> processes_, ended_;
  Corpus corpus_;
  std::array<int, 2> begin_{}, farthest_{};
};

TEST_F(Mutation, AtTheLoopOnCycloneDdsEndsInHoldOrInClosedBrakes) {
  std::map<std::string, long> before_kb;
  for (const auto& process : processes_) before_kb[process] = resident_kb(*pid_of(process));
  fire_at(processes_);
  stack_->listen(500ms);
  watch();
  expect_no_motion();
  for (const auto& process : processes_) {
    if (!pid_of(process)) continue;
    const auto grown_kb = resident_kb(*pid_of(process)) - before_kb[process];
    std::cout << process << ": memory grew by " << grown_kb << " kB\n";
    EXPECT_LE(grown_kb, kGrowth_kb) << process;
  }
  EXPECT_TRUE(ended_.empty());
  stack_->forget();
  stack_->listen(500ms);
  const bool holds = supervisor_is(crane_STATE_HOLD);
  const auto& lines = monitor_->lines();
  std::cout << (holds ? "the crane still holds\n" : "the crane was stopped\n");
  EXPECT_TRUE(holds || lines.brakes_closed_ns > 0);
}

TEST_F(Mutation, AtAnObserverOnFastDdsDoesNotDisturbTheLoop) {
  fire_at({"recorder"});
  stack_->listen(500ms);
  watch();
  expect_no_motion();
  EXPECT_TRUE(supervisor_is(crane_STATE_HOLD)) << experiments::in_words(stack_->observer().statuses().back());
  EXPECT_TRUE(std::all_of(ended_.begin(), ended_.end(), [](const auto& name) { return name == "recorder"; }));
  const auto& states = stack_->observer().states();
  std::cout << "the recorder " << (ended_.empty() ? "still runs" : "died") << "; overruns of the loop "
            << states.back().overruns - states.front().overruns << '\n';
}

}  // namespace
}  // namespace crane::hostile
