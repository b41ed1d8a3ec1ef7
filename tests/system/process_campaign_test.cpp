/// The fault campaign with real processes: every process of the control loop is killed and stopped, and every
/// loop topic forged, at random moments; also the whole loop on a lossy link. The judge of the campaign,
/// which shares no code with supervisor and bridge, judges the recording. CRANE_PROCESS_SEED selects moments
/// and order, CRANE_PROCESS_ROUNDS the number of repetitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <random>

#include "../recording/temporary_directory.hpp"
#include "process_fault.hpp"
#include "recorded_run.hpp"
#include "stack/data_files.hpp"
#include "stranger.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using campaign::Expectation;

constexpr std::uint32_t kDomain = 76;
constexpr const char* kRig = "virginia_tech_tower";
constexpr auto kWatched = 600ms;
constexpr double kMoving_mps = 0.15;

std::uint64_t number_from(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// Time within which a reliable writer repeats lost samples.
constexpr auto kRepeated = 200ms;

struct Struck {
  std::string name{};
  Expectation expectation{};
  std::int64_t onset_ns = 0, end_ns = 0;
  std::int64_t lead_ns = 0;  ///< judged time before the onset: since the crane was LOCKED
  bool forged = false, lossy = false, hits_supervisor = false;
};

/// A signal can stop the supervisor between two sends: the plant has received a command, and the recorder has
/// not.
bool names_a_command_that_the_recorder_did_not_get(const campaign::Run& run, std::int64_t time_ns) {
  const auto row = std::ranges::find(run.rows, time_ns, &campaign::Row::time_ns);
  return row != run.rows.end() && row->state.applied_command_tick == row->command.header.tick + 1;
}

class ProcessCampaign : public testing::Test {
 protected:
  void start() {
    stack_.emplace(kDomain, kRig);
    auto arguments = runtime::arguments(stack_->bus_options());
    arguments[1] = "fastdds";
    arguments.insert(arguments.begin(), {"record", recording_.string()});
    stack_->children().start("recorder", "crane", arguments);
    ASSERT_TRUE(stack_->until([this] { return stack_->observer().nodes().contains("recorder"); }, 10s));
  }
  [[nodiscard]] bool is(crane_SupervisorState state) const {
    const auto& statuses = stack_->observer().statuses();
    return !statuses.empty() && statuses.back().state == state;
  }
  [[nodiscard]] std::int64_t now_ns() const { return clock_ns(CLOCK_MONOTONIC); }

  void bring_to(When when) {
    if (!is(crane_STATE_HOLD)) {
      locked_ns_ = now_ns();
      stack_->session().arm();
    }
    stack_->listen(100ms);
    if (when == When::idle) return;
    const bool far = stack_->session().state()->trolley_position_m > 0.65;
    stack_->session().request({.kind = crane_REQUEST_MOVE,
                               .selected = {true, true, false},
                               .target = {far ? 0.3 : 1.05, far ? 0.0 : 1.5, 0}},
                              "move");
    stack_->forget();
    ASSERT_TRUE(stack_->until(
        [this] {
          const auto& states = stack_->observer().states();
          return !states.empty() && std::abs(states.back().trolley_speed_mps) > kMoving_mps;
        },
        5s))
        << "state " << stack_->observer().statuses().back().state << ", cause "
        << stack_->observer().statuses().back().cause << ", trolley at "
        << stack_->observer().states().back().trolley_position_m;
    if (when == When::stopping) stack_->session().request({.kind = crane_REQUEST_STOP}, "stop");
  }

  Struck strike(const Fault& fault, When when) {
    Struck struck{.name = name_of(fault, when), .expectation = expectation_of(fault)};
    struck.forged = fault.component == nullptr;
    struck.hits_supervisor = !struck.forged && std::string_view{fault.component} == "supervisor";
    struck.onset_ns = now_ns();
    if (fault.component != nullptr) {
      stack_->send(fault.component, fault.signal);
      stack_->listen(kWatched);
    } else {
      struck.onset_ns = forge(fault);
    }
    struck.lead_ns = struck.onset_ns - locked_ns_;
    struck.end_ns = now_ns();
    return struck;
  }
  /// @return time at which the foreign writer joined
  std::int64_t forge(const Fault& fault) {
    auto options = stack_->bus_options();
    options.vendor = fault.vendor;
    std::int64_t joined_ns = 0;
    with_forgery_of(fault.topic, [&](const auto& topic, auto spoil) {
      Stranger stranger{options, topic, spoil, 1};
      joined_ns = stranger.joined_ns();
      const auto stopped = [&] {
        stranger.speak();
        return is(crane_STATE_STOP_C0) || is(crane_STATE_LOCKED);
      };
      (void)stack_->until(stopped, kFound + kWatched);
      (void)stack_->until([&] { return stranger.speak(), false; }, kWatched);
    });
    return joined_ns;
  }
  /// Restores the stack; the crane is LOCKED.
  void repair(const Fault& fault) {
    if (fault.component != nullptr && fault.signal == SIGSTOP) stack_->send(fault.component, SIGCONT);
    if (fault.component != nullptr && fault.signal == SIGKILL) stack_->start_again(fault.component);
    stack_->forget();
    ASSERT_TRUE(stack_->until([this] { return is(crane_STATE_LOCKED); }, 10s));
  }

  /// Stops the recorder and judges every run. @return number of runs in which the crane was stopped
  std::size_t judge(const std::vector<Struck>& all) {
    const auto recorder = *stack_->children().pid_of("recorder");
    ::kill(recorder, SIGTERM);
    EXPECT_TRUE(stack_->until(
        [this] { return !stack_->children().pid_of("recorder") || recorder_has_ended(); }, 10s));
    const Recorded recorded{recording_};
    EXPECT_GT(recorded.states(), 100U);
    std::size_t stopped = 0;
    for (const auto& struck : all) {
      campaign::Run run{.begin_ns = struck.onset_ns - struck.lead_ns,  // LOCKED because of the previous fault
                        .onset_ns = struck.onset_ns,
                        .visible_ns = struck.onset_ns,
                        .expectation = struck.expectation};
      run.rows = recorded.rows(run.begin_ns, struck.end_ns, !struck.forged);
      EXPECT_GT(run.rows.size(), 30U) << struck.name;
      const auto verdict = campaign::judge(rig_, run);
      stopped += verdict.first ? 1 : 0;
      std::cout << struck.name << ": "
                << (verdict.first ? "stopped, cause " + std::to_string(verdict.first->cause)
                                  : std::string{"not stopped"})
                << ", detected after " << verdict.detection_ms.value_or(-1) << " ms, 0 V after "
                << verdict.zero_volts_ms.value_or(-1) << " ms, braked after "
                << verdict.braked_ms.value_or(-1) << " ms\n";
      for (const auto& violation : verdict.violations) {
        // The recorder loses commands as often as the bridge.
        if (struck.lossy && violation.invariant == campaign::Invariant::only_supervisor) continue;
        if (struck.hits_supervisor && violation.invariant == campaign::Invariant::only_supervisor &&
            names_a_command_that_the_recorder_did_not_get(run, violation.time_ns))
          continue;
        ADD_FAILURE() << struck.name << ": " << campaign::name_of(violation.invariant) << ": "
                      << violation.what << ", "
                      << static_cast<double>(violation.time_ns - struck.onset_ns) * 1e-6
                      << " ms after the onset";
      }
    }
    return stopped;
  }
  [[nodiscard]] bool recorder_has_ended() {
    const auto ended = stack_->children().ended();
    return ended && ended->name == "recorder";
  }

  recording::TemporaryDirectory directory_;
  std::filesystem::path recording_ = directory_ / "run.mcap";
  const configuration::Rig rig_ = configuration::load_rig(stack::find_rig(kRig));
  std::optional<RunningStack> stack_;
  std::int64_t locked_ns_ = 0;
};

TEST_F(ProcessCampaign, EveryProcessAndEveryTopicAtRandomMoments) {
  start();
  const auto seed = number_from("CRANE_PROCESS_SEED", 1);
  std::mt19937 random{static_cast<std::mt19937::result_type>(seed)};
  std::vector<Fault> faults;
  for (std::uint64_t round = 0; round < number_from("CRANE_PROCESS_ROUNDS", 1); ++round)
    faults.insert(faults.end(), kFaults.begin(), kFaults.end());
  std::ranges::shuffle(faults, random);
  std::cout << "seed " << seed << ", " << faults.size() << " runs\n";
  std::vector<Struck> all;
  for (const auto& fault : faults) {
    const auto when = static_cast<When>(random() % kMoments.size());
    SCOPED_TRACE(name_of(fault, when));
    ASSERT_NO_FATAL_FAILURE(bring_to(when));
    std::cout << name_of(fault, when) << std::endl;
    all.push_back(strike(fault, when));
    ASSERT_NO_FATAL_FAILURE(repair(fault));
  }
  (void)judge(all);
}

/// Share of packets that every process loses (lossy_sockets.cpp).
class Link {
 public:
  explicit Link(std::filesystem::path file) : file_{std::move(file)} {
    lose(0);
    ::setenv("CRANE_LOST_FILE", file_.c_str(), 1);
    ::setenv("LD_PRELOAD", (stack::program_directory() / "liblossy_sockets.so").c_str(), 1);
  }
  void lose(double share) const {
    std::ofstream out{file_, std::ios::binary | std::ios::in | std::ios::out};
    if (!out) out.open(file_, std::ios::binary);
    out.write(reinterpret_cast<const char*>(&share), sizeof share);
  }
  /// Processes that start later lose no packets.
  static void leave() { ::unsetenv("LD_PRELOAD"); }

 private:
  std::filesystem::path file_;
};

/// Lost packets may stop the crane with a reason that names the loss; they must not cause forbidden motion.
TEST_F(ProcessCampaign, ALossyLinkHasNoEffectOrStopsTheCrane) {
  ASSERT_TRUE(std::filesystem::exists(stack::program_directory() / "liblossy_sockets.so"));
  ::setenv("CRANE_LOST_SEED", std::to_string(number_from("CRANE_PROCESS_SEED", 1)).c_str(), 1);
  const Link link{directory_ / "share"};
  start();
  Link::leave();
  std::vector<Struck> all;
  for (const double share : {0.01, 0.02, 0.05, 0.1, 0.2, 0.5}) {
    Struck struck{.name = std::to_string(static_cast<int>(100 * share)) + " % of the packets lost, moving"};
    struck.expectation = {.reasons = {{crane_CAUSE_DEMAND_STALE, crane_LATCH_NONE},
                                      {crane_CAUSE_STATE_STALE, crane_LATCH_NONE},
                                      {crane_CAUSE_BRIDGE_LATCHED, crane_LATCH_COMMAND_STALE}},
                          .may_ride_through = true,
                          .detection_ms = 1e6,
                          .loses_commands = true,
                          .bridge_delay_ms = kLate_ms};
    struck.lossy = true;
    ASSERT_NO_FATAL_FAILURE(bring_to(When::moving));
    struck.onset_ns = now_ns();
    struck.lead_ns = struck.onset_ns - locked_ns_;
    link.lose(share);
    stack_->listen(1s);
    struck.end_ns = now_ns();
    link.lose(0);
    all.push_back(struck);
    stack_->listen(kRepeated);  // repeated old states must not count for the next request
    ASSERT_TRUE(stack_->until([this] { return is(crane_STATE_LOCKED) || is(crane_STATE_HOLD); }, 10s));
  }
  EXPECT_GT(judge(all), 0U) << "half of the packets lost, and the crane did not stop: are they lost?";
}

}  // namespace
}  // namespace crane::system_test
