/// A move in real time settles like the same move in lockstep.
#include <gtest/gtest.h>

#include <iostream>

#include "../recording/temporary_directory.hpp"
#include "crane/experiment/metrics.hpp"
#include "experiments/experiment_run.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 61;
constexpr auto kMeasured = 5s;
constexpr const char* kScenario = R"(description = "trolley from where the rig file puts it to 1.0 m"
duration_s = 5
[[move]]
at_s = 0.2
trolley_position_m = 1.0
)";

TEST(Realtime, AMoveSettlesAsInLockstep) {
  const recording::TemporaryDirectory directory;
  const auto file = directory / "move.toml";
  recording::put_contents(file, kScenario);
  const auto rig_file = stack::find_rig("virginia_tech_tower");
  const auto lockstep = experiments::run_experiment({.scenario = file,
                                                     .rig = rig_file,
                                                     .controller = "",
                                                     .variant = "",
                                                     .directory = directory / "lockstep",
                                                     .in_process = true,
                                                     .picture = false,
                                                     .bus = {},
                                                     .vendors = {}});
  ASSERT_TRUE(lockstep.metrics.settling_time_s.has_value());

  RunningStack stack{kDomain, "virginia_tech_tower"};
  auto& session = stack.session();
  session.arm();
  session.start_table();
  const auto zero_ns = session.state()->header.sample_time_ns;
  const auto rig = configuration::load_rig(rig_file);
  auto scenario = experiment::load_scenario(file, &rig);
  scenario.moves.front().at_s = 0;
  session.request({.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {1.0, 0, 0}},
                  "move");
  session.wait(kMeasured);

  const auto samples = experiment::samples_from(session.table().table(zero_ns));
  const auto metrics = experiment::evaluate(samples, experiment::maneuver_of(scenario, rig));
  ASSERT_TRUE(metrics.settling_time_s.has_value());
  std::cout << "settled after " << *metrics.settling_time_s << " s, in lockstep "
            << *lockstep.metrics.settling_time_s << " s; " << metrics.lost_ticks << " of " << samples.size()
            << " ticks lost, " << session.state()->overruns << " late\n";
  EXPECT_NEAR(*metrics.settling_time_s, *lockstep.metrics.settling_time_s,
              0.05 * *lockstep.metrics.settling_time_s);
  EXPECT_EQ(session.status()->state, crane_STATE_HOLD);
  // A busy computer may skip a tick; a larger loss is a defect of the stack.
  EXPECT_LE(static_cast<double>(metrics.lost_ticks), 0.01 * static_cast<double>(samples.size()));
}

/// The last status that the session has seen reports a stop, which has ended since.
TEST(Realtime, ASessionArmsACraneThatWasLockedWhileItDidNotLook) {
  RunningStack stack{kDomain, "virginia_tech_tower"};
  auto& session = stack.session();
  session.arm();
  session.request({.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {1.0, 0, 0}},
                  "move");
  session.wait_for(crane_STATE_RUN, 1s);
  session.wait(300ms);
  session.request({.kind = crane_REQUEST_STOP}, "stop");
  for (int i = 0; i < 50 && session.status()->state != crane_STATE_STOP_C1; ++i) session.wait(10ms);
  ASSERT_EQ(session.status()->state, crane_STATE_STOP_C1);
  bus::Bus other_bus{runtime::bus_options(stack.bus_options(), "observer", crane_SOURCE_OPERATOR, 0)};
  Observer other{other_bus};
  const auto is_locked = [&other] {
    return !other.statuses().empty() && other.statuses().back().state == crane_STATE_LOCKED;
  };
  const auto deadline = std::chrono::steady_clock::now() + 5s;
  while (!is_locked() && std::chrono::steady_clock::now() < deadline) {
    other_bus.wait(20ms);
    other.take();
  }
  ASSERT_TRUE(is_locked());
  EXPECT_NO_THROW(session.arm());
}

TEST(Realtime, AScenarioByCommandWritesTheMeasurements) {
  const recording::TemporaryDirectory directory;
  recording::put_contents(directory / "move.toml", kScenario);
  const auto ended = run_program(stack::program_directory() / "crane",
                                 {"run", (directory / "move.toml").string(), "--clock", "realtime", "--out",
                                  (directory / "out").string(), "--domain", std::to_string(kDomain)});
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  const auto table = recording::read_csv(directory / "out" / "run.csv");
  const auto* time_s = table.find("time_s");
  const auto* trolley_m = table.find("trolley_position_m");
  ASSERT_TRUE(time_s != nullptr && trolley_m != nullptr);
  EXPECT_NEAR(time_s->back(), 5.2, 0.1) << "duration_s after the last move";
  EXPECT_NEAR(trolley_m->back(), 1.0, 0.05);
}

}  // namespace
}  // namespace crane::system_test
