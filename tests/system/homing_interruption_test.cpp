/// A process is killed or paused in each phase of homing. Nothing moves before a reset, a position never
/// becomes known with a wrong value, and homing succeeds afterwards.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <iostream>
#include <tuple>

#include "../recording/temporary_directory.hpp"
#include "crane/boards/linked_rig.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 83;
constexpr double kStart_m = 0.07;  ///< 0.02 m from the mark
constexpr double kCreeping_mps = 0.02;
/// Width of the region in which the mark is active, and the motion within a tick.
constexpr double kWrong_m = 0.003;

enum class Phase : std::uint8_t {
  arming,    ///< the supervisor opens the brake
  approach,  ///< the axis moves towards its mark
  at_mark,   ///< the mark is active
  back_off   ///< the axis leaves the mark
};
constexpr std::array kPhases{"arming", "approach", "at_mark", "back_off"};

using Case = std::tuple<const char*, int, Phase>;

class HomingInterruption : public testing::TestWithParam<Case> {
 protected:
  HomingInterruption() {
    recording::put_contents(rig_, "extends = \"" + stack::find_rig("homing_servo_to_go").string() +
                                      "\"\n[start]\ntrolley_position_m = " + std::to_string(kStart_m) + "\n");
    running_.emplace(kDomain, rig_.string(), stack::Plant::hardware);
    lines_.emplace(bridge::shared_lines_name(running_->bus_options().crane, kDomain));
  }
  [[nodiscard]] const msg::State& state() const { return running_->observer().states().back(); }
  [[nodiscard]] crane_SupervisorState supervisor_state() const {
    return running_->observer().statuses().back().state;
  }
  /// True position, from the pulses of the emulated encoder.
  [[nodiscard]] double truth_m() const {
    const auto encoder = configuration::load_rig(rig_).encoders[0];
    return kStart_m +
           lines_->lines().pulses[static_cast<std::size_t>(encoder.channel)] / encoder.counts_per_unit;
  }
  [[nodiscard]] bool reached(Phase phase) {
    const auto& states = running_->observer().states();
    if (states.empty() || running_->observer().statuses().empty()) return false;
    seen_mark_ = seen_mark_ || states.back().mark_active[0];
    switch (phase) {
      case Phase::arming:
        return supervisor_state() == crane_STATE_ARMING;
      case Phase::approach:
        return !seen_mark_ && std::abs(states.back().trolley_speed_mps) > kCreeping_mps;
      case Phase::at_mark:
        return states.back().mark_active[0];
      case Phase::back_off:
        return seen_mark_ && !states.back().mark_active[0];
    }
    return false;
  }
  void home() {
    running_->session().request_with_patience({.kind = crane_REQUEST_RESET}, "reset");
    const auto give_up = std::chrono::steady_clock::now() + 5s;
    while (true) try {  // arming needs complete inputs for a second
        return running_->session().request({.kind = crane_REQUEST_HOME, .selected = {true, false, false}},
                                           "home");
      } catch (const experiments::SessionError&) {
        if (std::chrono::steady_clock::now() > give_up) throw;
        running_->session().request_with_patience({.kind = crane_REQUEST_RESET}, "reset");
        running_->listen(200ms);
      }
  }
  void expect_correct_or_unknown() const {
    if (state().position_known[0]) {
      EXPECT_NEAR(state().trolley_position_m, truth_m(), kWrong_m);
    }
  }
  /// The crane is locked with closed brakes, and stays so for a second.
  void expect_rest() {
    ASSERT_TRUE(running_->until([this] { return supervisor_state() == crane_STATE_LOCKED; }, 10s))
        << experiments::in_words(running_->observer().statuses().back());
    std::cout << experiments::in_words(running_->observer().statuses().back()) << '\n';
    running_->listen(200ms);
    running_->forget();
    const double before_m = truth_m();
    running_->listen(1s);
    for (const auto& one : running_->observer().states())
      for (std::size_t i = 0; i < 2; ++i)
        ASSERT_TRUE(one.applied_v[i] == 0 && one.brake_closed[i]) << "tick " << one.header.tick;
    EXPECT_EQ(truth_m(), before_m);
    expect_correct_or_unknown();
  }

  recording::TemporaryDirectory directory_;
  std::filesystem::path rig_ = directory_ / "near_its_mark.toml";
  std::optional<RunningStack> running_;
  std::optional<bridge::RigMonitor> lines_;
  bool seen_mark_ = false;
};

TEST_P(HomingInterruption, MovesNothingBeforeAResetAndHomingSucceedsAfterwards) {
  const auto [process, signal, phase] = GetParam();
  running_->session().wait_for(crane_STATE_LOCKED, 5s);
  home();
  ASSERT_TRUE(running_->until([this, wanted = phase] { return reached(wanted); }, 20s));
  running_->send(process, signal);
  if (signal == SIGSTOP) {
    running_->listen(500ms);
    running_->send(process, SIGCONT);
  } else {
    running_->start_again(process);
  }
  running_->listen(1s);
  ASSERT_NO_FATAL_FAILURE(expect_rest());
  if (signal == SIGSTOP) return;
  try {
    home();
  } catch (const experiments::SessionError& error) {
    // A load that swings at the start of a bridge has no known zero: only a further restart ends this
    // refusal.
    ASSERT_STREQ(process, "hardware_bridge") << error.what();
    ASSERT_NE(std::string{error.what()}.find("the load swung"), std::string::npos) << error.what();
    EXPECT_FALSE(state().position_known[0]);
    return;
  }
  const auto homed = [this] { return supervisor_state() == crane_STATE_LOCKED && state().position_known[0]; };
  EXPECT_TRUE(running_->until(homed, 30s)) << experiments::in_words(running_->observer().statuses().back());
  EXPECT_TRUE(state().position_known[0]);
  expect_correct_or_unknown();
}

std::string name_of_case(const testing::TestParamInfo<Case>& test) {
  const auto& [process, signal, phase] = test.param;
  return std::string{process} + (signal == SIGKILL ? "_killed_" : "_paused_") +
         kPhases.at(static_cast<std::size_t>(phase));
}

constexpr std::array kProcesses{"hardware_bridge", "trajectory_planner", "supervisor"};

constexpr std::array kSignals{SIGKILL, SIGSTOP};

/// Each signal in each phase to one process in turn; the other processes are Long tests.
std::vector<Case> cases(bool usual) {
  std::vector<Case> chosen;
  for (std::size_t process = 0; process < kProcesses.size(); ++process)
    for (std::size_t signal = 0; signal < kSignals.size(); ++signal)
      for (std::size_t phase = 0; phase < kPhases.size(); ++phase)
        if (((process + signal + phase) % kProcesses.size() == 0) == usual)
          chosen.emplace_back(kProcesses[process], kSignals[signal], static_cast<Phase>(phase));
  return chosen;
}
INSTANTIATE_TEST_SUITE_P(InEachPhase, HomingInterruption, testing::ValuesIn(cases(true)), name_of_case);
INSTANTIATE_TEST_SUITE_P(LongInEachPhase, HomingInterruption, testing::ValuesIn(cases(false)), name_of_case);

}  // namespace
}  // namespace crane::system_test
