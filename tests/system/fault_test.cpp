/// Processes that end or hang during a move: within 100 ms the drives are at 0 V and the brakes closed, until
/// an operator resets and arms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "../recording/temporary_directory.hpp"
#include "crane/supervisor/states.hpp"
#include "running_stack.hpp"
#include "timer_witness.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 62;
constexpr std::int64_t kBound_ns = 100'000'000;
constexpr auto kWatched = 1s;

struct Fault {
  const char* component;
  int signal;
};

std::string name_of(int signal) { return signal == SIGKILL ? "SIGKILL" : "SIGSTOP"; }
std::ostream& operator<<(std::ostream& out, const Fault& fault) {
  return out << name_of(fault.signal) << " to " << fault.component;
}
std::string test_name(const testing::TestParamInfo<Fault>& test) {
  return std::string{test.param.component} + "_" + name_of(test.param.signal);
}
double ms(std::int64_t duration_ns) { return static_cast<double>(duration_ns) * 1e-6; }

bool is_at_rest(const msg::State& state) {
  for (std::size_t i = 0; i < 3; ++i)
    if (state.applied_v[i] != 0 || !state.brake_closed[i]) return false;
  return true;
}
bool asks_for_nothing(const msg::Command& command) {
  for (std::size_t i = 0; i < 3; ++i)
    if (command.drive_v[i] != 0 || command.brake_release[i]) return false;
  return true;
}

/// Index of the first sample from which on all samples are `quiet`; samples.size() when the last one is not.
template <class T>
std::size_t quiet_from(const std::vector<T>& samples, bool (*quiet)(const T&)) {
  auto first = samples.size();
  while (first > 0 && quiet(samples[first - 1])) --first;
  return first;
}

class FaultTest : public testing::Test {
 protected:
  /// A move of the trolley by 0.5 m and of the jib by 1.5 rad; returns while both move.
  void get_going() {
    if (stack_.session().status()->state != crane_STATE_HOLD) stack_.session().arm();
    const auto start = stack_.session().state().value();
    // Steps of the reference (profile_limits.hpp), so that both axes become fast.
    trolley_m_ = start.trolley_position_m + (start.trolley_position_m > 0.75 ? -0.5 : 0.5);
    slew_rad_ = start.slew_angle_rad + (start.slew_angle_rad > 0.2 ? -1.5 : 1.5);
    stack_.session().request(
        {.kind = crane_REQUEST_MOVE, .selected = {true, true, false}, .target = {trolley_m_, slew_rad_, 0}},
        "move");
    ASSERT_TRUE(stack_.until(
        [this] {
          if (stack_.observer().states().empty()) return false;
          const auto& state = stack_.observer().states().back();
          return std::abs(state.trolley_speed_mps) > 0.15 && std::abs(state.slew_speed_radps) > 0.4;
        },
        5s))
        << "from " << start.trolley_position_m << " m and " << start.slew_angle_rad << " rad to "
        << trolley_m_ << " m and " << slew_rad_ << " rad the axes reached " << fastest(0) << " m/s and "
        << fastest(1) << " rad/s; supervisor " << supervisor_in_words();
    stack_.forget();
  }
  [[nodiscard]] double fastest(int axis) const {
    double speed = 0;
    for (const auto& state : observer().states())
      speed = std::max(speed, std::abs(axis == 0 ? state.trolley_speed_mps : state.slew_speed_radps));
    return speed;
  }
  [[nodiscard]] const Observer& observer() const { return stack_.observer(); }
  [[nodiscard]] std::size_t rest_begins() const { return quiet_from(observer().states(), is_at_rest); }
  [[nodiscard]] bool supervisor_is(crane_SupervisorState state) const {
    return !observer().statuses().empty() && observer().statuses().back().state == state;
  }
  [[nodiscard]] std::string supervisor_in_words() const {
    if (observer().statuses().empty()) return "silent";
    const auto& status = observer().statuses().back();
    return std::string{supervisor::name_of(static_cast<supervisor::State>(status.state))} + " because of " +
           supervisor::name_of(static_cast<supervisor::Cause>(status.cause));
  }
  /// With all processes running again, the crane does not move until an operator acts.
  void expect_rest_until_reset_and_arm() {
    stack_.forget();
    ASSERT_TRUE(stack_.until([this] { return supervisor_is(crane_STATE_LOCKED); }, 5s))
        << supervisor_in_words();
    stack_.listen(kWatched);
    ASSERT_GT(observer().states().size(), 50U);
    EXPECT_EQ(rest_begins(), 0U);
    EXPECT_TRUE(supervisor_is(crane_STATE_LOCKED)) << supervisor_in_words();
    EXPECT_NO_THROW(stack_.session().arm());
  }

  RunningStack stack_{kDomain, "virginia_tech_tower"};
  double trolley_m_ = 0, slew_rad_ = 0;  ///< target of the move
};

class LoopFault : public FaultTest {
 protected:
  void strike(const Fault& fault) {
    ASSERT_NO_FATAL_FAILURE(get_going());
    const auto signal_ns = clock_ns(CLOCK_MONOTONIC);
    stack_.send(fault.component, fault.signal);
    const auto kEnough = 5U;
    ASSERT_TRUE(stack_.until([this] { return rest_begins() + kEnough < observer().states().size(); }, 2s));
    stack_.listen(kWatched);

    const auto first = rest_begins();
    ASSERT_LT(first, observer().states().size());
    const auto taken_ns = observer().states()[first].header.sample_time_ns - signal_ns;
    std::cout << fault << ": 0 V and brakes closed after " << ms(taken_ns) << " ms; supervisor "
              << supervisor_in_words() << '\n';
    EXPECT_LE(taken_ns, kBound_ns);
    EXPECT_GT(taken_ns, 0) << "the crane was not moving";

    if (fault.signal == SIGSTOP)
      stack_.send(fault.component, SIGCONT);
    else
      stack_.start_again(fault.component);
    expect_rest_until_reset_and_arm();
  }
};

/// One fault after the other in the same stack, which must move again after each.
TEST_F(LoopFault, OfEachProcessStopsTheCraneWithin100MsAndForGood) {
  for (const char* component :
       {"trajectory_planner", "tracking", "anti_swing", "friction_compensation", "supervisor"})
    for (const int signal : {SIGKILL, SIGSTOP}) {
      const Fault fault{component, signal};
      SCOPED_TRACE(testing::PrintToString(fault));
      ASSERT_NO_FATAL_FAILURE(strike(fault));
    }
}

class PlantFault : public FaultTest, public testing::WithParamInterface<Fault> {};

TEST_P(PlantFault, StopsTheSupervisorWithin100Ms) {
  get_going();
  const auto signal_ns = clock_ns(CLOCK_REALTIME);
  const auto before = stack_.session().state().value();
  stack_.send("plant", GetParam().signal);
  const auto asks_again = [this] { return quiet_from(observer().commands(), asks_for_nothing); };
  const auto kEnough = 5U;
  ASSERT_TRUE(stack_.until([&] { return asks_again() + kEnough < observer().commands().size(); }, 2s));
  stack_.listen(kWatched);

  const auto& statuses = observer().statuses();
  const auto stopped = std::find_if(statuses.begin(), statuses.end(), [](const auto& status) {
    return status.state >= crane_STATE_STOP_C1 || status.state <= crane_STATE_LOCKED;
  });
  ASSERT_NE(stopped, statuses.end());
  const auto stop_ns =
      observer().status_times_ns()[static_cast<std::size_t>(stopped - statuses.begin())] - signal_ns;
  ASSERT_LT(asks_again(), observer().commands().size());
  const auto quiet_ns = observer().command_times_ns()[asks_again()] - signal_ns;
  std::cout << GetParam() << ": stop state after " << ms(stop_ns)
            << " ms, 0 V and brakes closed commanded after " << ms(quiet_ns) << " ms; supervisor "
            << supervisor_in_words() << '\n';
  EXPECT_EQ(stopped->cause, crane_CAUSE_STATE_STALE);
  EXPECT_LE(stop_ns, kBound_ns);
  EXPECT_LE(quiet_ns, kBound_ns);
  if (GetParam().signal != SIGSTOP) return;

  // The time of the rig continued: its relay has closed the brakes when the process answers again.
  stack_.forget();
  stack_.send("plant", SIGCONT);
  stack_.listen(kWatched);
  const auto& states = observer().states();
  ASSERT_GT(states.size(), 50U);
  EXPECT_EQ(rest_begins(), 0U);
  EXPECT_TRUE(states.front().watchdog_dropped);
  const auto trolley_m = std::abs(states.front().trolley_position_m - before.trolley_position_m);
  const auto slew_rad = std::abs(states.front().slew_angle_rad - before.slew_angle_rad);
  std::cout << "  travelled meanwhile: trolley " << trolley_m << " m, slew " << slew_rad
            << " rad; supervisor " << supervisor_in_words() << '\n';
  // 0.1 s at the largest speed of the rig file, then the stopping distance: v t + v^2/2a.
  EXPECT_LE(trolley_m, 1.5 * 0.1 + 1.5 * 1.5 / (2 * 20));
  EXPECT_LE(slew_rad, 3.5 * 0.1 + 3.5 * 3.5 / (2 * 11));
}

INSTANTIATE_TEST_SUITE_P(ThePlant, PlantFault,
                         testing::Values(Fault{"plant", SIGKILL}, Fault{"plant", SIGSTOP}), test_name);

class ObserverFault : public FaultTest, public testing::WithParamInterface<Fault> {};
constexpr auto kReported = 1500ms;  // every process has reported in this time

/// Lost ticks in a row that the supervisor tolerates. A writer that waits for a dead reader would lose ten at
/// a time.
constexpr std::uint64_t kBridged = 2;

/// Number of ticks that each process of the loop has lost so far.
std::map<std::string, std::uint64_t> lost_ticks(const Observer& observer) {
  std::map<std::string, std::uint64_t> lost;
  for (const auto& [name, status] : observer.nodes())
    if (name != "recorder") lost[name] = status.lost_ticks;
  return lost;
}

TEST_P(ObserverFault, DoesNotDisturbTheMove) {
  const recording::TemporaryDirectory directory;
  auto arguments = runtime::arguments(stack_.bus_options());
  arguments[1] = "fastdds";
  arguments.insert(arguments.begin(), {"record", (directory / "run.mcap").string()});
  stack_.children().start("recorder", "crane", arguments);
  ASSERT_TRUE(stack_.until([this] { return observer().nodes().contains("recorder"); }, 10s));
  real_time_test::TimerWitness witness;
  get_going();
  const auto lost_before = lost_ticks(observer());
  const auto signal_ns = clock_ns(CLOCK_MONOTONIC);
  stack_.send("recorder", GetParam().signal);
  const auto arrived = [this] {
    const auto& state = observer().states().back();
    return supervisor_is(crane_STATE_HOLD) && std::abs(state.trolley_position_m - trolley_m_) < 0.02 &&
           std::abs(state.slew_angle_rad - slew_rad_) < 0.03;
  };
  EXPECT_TRUE(stack_.until(arrived, 15s)) << supervisor_in_words();
  stack_.listen(kReported);

  for (const auto& status : observer().statuses())
    ASSERT_TRUE(status.state == crane_STATE_RUN || status.state == crane_STATE_HOLD)
        << supervisor_in_words() << ", tick " << status.header.tick << ", "
        << ms(status.header.sample_time_ns - signal_ns) << " ms after the signal";
  const auto& states = observer().states();
  ASSERT_GT(states.size(), 200U);
  const auto pauses = witness.take();  // each pause of the computer costs ticks, too
  EXPECT_LE(states.back().header.tick - states.front().header.tick + 1, states.size() + pauses.ticks);
  std::uint64_t most_lost = 0;
  for (const auto& [name, lost] : lost_ticks(observer()))
    most_lost = std::max(most_lost, lost - lost_before.at(name));
  EXPECT_LE(most_lost, kBridged + pauses.ticks);
  std::cout << GetParam() << ": " << states.size() << " ticks, "
            << states.back().overruns - states.front().overruns << " late, at most " << most_lost
            << " lost by a process, " << pauses.pauses << " pauses of the computer\n";
}

INSTANTIATE_TEST_SUITE_P(ARecorder, ObserverFault,
                         testing::Values(Fault{"recorder", SIGKILL}, Fault{"recorder", SIGSTOP}), test_name);

}  // namespace
}  // namespace crane::system_test
