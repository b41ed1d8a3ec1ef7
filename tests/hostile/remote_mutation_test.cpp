/// Mutated RTPS packets from another host, at all ports of a stack without keys. Permitted: the processes
/// continue, or the crane stops. Forbidden: motion, open brakes without control, growing memory.
#include <gtest/gtest.h>

#include "crane/boards/linked_rig.hpp"
#include "mutate.hpp"
#include "remote_attack.hpp"
#include "stack/data_files.hpp"

namespace crane::hostile {
namespace {

constexpr std::uint64_t kSeed = 2'601;
constexpr std::uint64_t kPerSecond = 20'000;  ///< the sockets drop packets beyond this rate
constexpr auto kDuration = 5s;
constexpr const char* kCardRig = "emulated_servo_to_go";

/// The attacked crane is the emulated rig: its relay and its brakes act when processes of the stack die.
class RemoteMutation : public RemoteAttack, public testing::WithParamInterface<const char*> {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    ASSERT_TRUE(hosts_.ok()) << "cannot make network namespaces with `ip netns`";
    near_.emplace(hosts_.near());
    auto options = reachable(system_test::launch_options(kDomain, kCardRig));
    options.bus.vendor = GetParam();
    ASSERT_NO_FATAL_FAILURE(start(options, stack::Plant::hardware));
    monitor_.emplace(bridge::shared_lines_name(options.bus.crane, kDomain));
  }
  /// What a program on the other host receives that reads all topics of the loop: discovery and samples.
  void collect() {
    const OnHost far{hosts_.far()};
    Ear ear{hosts_.far_device().c_str()};
    bus::Bus bus{runtime::bus_options(remote(), "stranger", crane_SOURCE_MONITOR, 9)};
    const auto readers = std::tuple{bus.subscriber(topics::state),      bus.subscriber(topics::reference),
                                    bus.subscriber(topics::tracking),   bus.subscriber(topics::anti_swing),
                                    bus.subscriber(topics::demand),     bus.subscriber(topics::command),
                                    bus.subscriber(topics::supervisor), bus.subscriber(topics::request)};
    const auto end = std::chrono::steady_clock::now() + 2s;
    while (std::chrono::steady_clock::now() < end)
      if (const auto packet = ear.next(10ms)) corpus_.add(packet->message);
    std::cout << corpus_.size() << " packets of " << corpus_.kinds() << " kinds heard\n";
    ASSERT_GT(corpus_.size(), 200U);
  }
  void fire() {
    const auto targets = all_ports();
    ASSERT_FALSE(targets.empty());
    const auto mouth = [&] {
      const OnHost far{hosts_.far()};
      return std::make_unique<Mouth>();
    }();
    Random random{kSeed};
    Packet packet;
    begin_ns_ = runtime::monotonic_ns();
    begin_m_ = trolley_m();
    const auto begin = std::chrono::steady_clock::now();
    for (std::uint64_t number = 0;; ++number) {
      const auto due = begin + std::chrono::nanoseconds{1'000'000'000 * number / kPerSecond};
      if (due > begin + kDuration) break;
      packet.to = targets[random() % targets.size()];
      packet.message = mutated(corpus_.any(random), corpus_.any(random), random);
      mouth->send(packet);
      if (number % 200 != 0) continue;
      farthest_m_ = std::max(farthest_m_, std::abs(trolley_m() - begin_m_));
      stack_->listen(std::max(0ms, std::chrono::duration_cast<std::chrono::milliseconds>(
                                       due - std::chrono::steady_clock::now())));
    }
    stack_->listen(500ms);
    farthest_m_ = std::max(farthest_m_, std::abs(trolley_m() - begin_m_));
    std::cout << mouth->sent() << " mutated packets to " << targets.size() << " ports, seed " << kSeed
              << '\n';
    ASSERT_GT(mouth->sent(), kPerSecond);
  }
  /// True position of the trolley.
  [[nodiscard]] double trolley_m() const {
    return static_cast<double>(monitor_->lines().pulses[0]) /
           configuration::load_rig(stack::find_rig(kCardRig)).encoders[0].counts_per_unit;
  }
  [[nodiscard]] bool brakes_have_closed() const { return monitor_->lines().brakes_closed_ns > begin_ns_; }

  std::optional<bridge::RigMonitor> monitor_;
  Corpus corpus_;
  std::int64_t begin_ns_ = 0;
  double begin_m_ = 0, farthest_m_ = 0;
};

TEST_P(RemoteMutation, EndsInHoldOrWithClosedBrakes) {
  ASSERT_NO_FATAL_FAILURE(collect());
  stack_->session().arm();
  const auto before_kb = memory_kb();
  ASSERT_NO_FATAL_FAILURE(fire());
  while (const auto ended = stack_->children().ended()) std::cout << stack::describe(*ended) << '\n';
  std::cout << experiments::in_words(stack_->observer().statuses().back()) << '\n';
  if (brakes_have_closed()) {
    std::cout << "brakes closed after " << (monitor_->lines().brakes_closed_ns - begin_ns_) / 1'000'000
              << " ms; ";
  } else {
    EXPECT_TRUE(is(crane_STATE_HOLD));
    stack_->session().request({.kind = crane_REQUEST_ESTOP}, "estop");
    EXPECT_TRUE(stack_->until([this] { return brakes_have_closed(); }, 1s)) << "no control, brakes open";
  }
  std::cout << "trolley moved by " << farthest_m_ << " m\n";
  EXPECT_LE(farthest_m_, kStill_m);
  expect_growth_below(64 * 1024, before_kb);  // history of the longest samples of every topic
}
INSTANTIATE_TEST_SUITE_P(AtTheLoop, RemoteMutation, testing::Values("cyclone", "fastdds"),
                         [](const auto& test) { return std::string{test.param}; });

}  // namespace
}  // namespace crane::hostile
