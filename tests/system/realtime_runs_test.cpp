/// Several runs in real time, each with new processes: a stop of the operator ends them all, and a real crane
/// keeps its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "../recording/temporary_directory.hpp"
#include "experiments/realtime_run.hpp"
#include "experiments/realtime_session.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using recording::TemporaryDirectory;

constexpr std::uint32_t kDomain = 59;

/// The newest status of a crane that another program operates.
class Watcher {
 public:
  explicit Watcher(const std::string& crane)
      : bus_{runtime::bus_options(options_of(crane), "watcher", crane_SOURCE_MONITOR, 0)}, observer_{bus_} {}

  bool until(const std::function<bool(const msg::SupervisorStatus&)>& holds, std::chrono::seconds patience) {
    const auto give_up = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < give_up) {
      bus_.wait(20ms);
      observer_.take();
      if (!observer_.statuses().empty() && holds(observer_.statuses().back())) return true;
    }
    return false;
  }

 private:
  static runtime::BusOptions options_of(const std::string& crane) {
    runtime::BusOptions options;
    options.domain = kDomain;
    options.crane = crane;
    return options;
  }
  bus::Bus bus_;
  Observer observer_;
};

TEST(RealtimeRuns, EndAtAStopOfTheOperator) {
  const TemporaryDirectory directory;
  const std::string crane = crane_name();
  const std::vector<std::string> on_bus{"--domain", std::to_string(kDomain), "--crane"};
  std::vector<std::string> arguments{
      "run", "maneuver_1", "maneuver_3", "--clock", "realtime", "--out", (directory / "").string()};
  arguments.insert(arguments.end(), on_bus.begin(), on_bus.end());
  arguments.push_back(crane);
  ProgramRun run{stack::program_directory() / "crane", arguments};
  const std::string first_run = crane + "_run_" + std::to_string(run.pid());
  Watcher watcher{first_run};
  ASSERT_TRUE(watcher.until([](const auto& status) { return status.state == crane_STATE_RUN; }, 30s));
  std::vector<std::string> stop{"stop"};
  stop.insert(stop.end(), on_bus.begin(), on_bus.end());
  stop.push_back(first_run);
  EXPECT_EQ(run_program(stack::program_directory() / "crane", stop).exit_code, 0);
  EXPECT_EQ(run.wait(10s), 1);
  EXPECT_THAT(run.errors(), testing::HasSubstr("OPERATOR_STOP"));
  EXPECT_FALSE(watcher.until([](const auto& status) { return status.state == crane_STATE_ARMING; }, 2s));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory / ""))
    EXPECT_NE(entry.path().filename(), "run.csv") << "a stopped run was reported as measured";
}

/// The run is kept: its rows are measured. The user learns that they are not the run of the scenario.
TEST(RealtimeRuns, NameARequestThatASuspensionOfTheProgramDelayed) {
  const TemporaryDirectory directory;
  const std::string crane = crane_name();
  const auto short_run = directory / "short.toml";
  recording::put_contents(short_run,
                          "description = \"a test\"\nduration_s = 1\n"
                          "[[move]]\nat_s = 0.1\ntrolley_position_m = 0.3\n"
                          "[[move]]\nat_s = 0.6\ntrolley_position_m = 0.35\n");
  ProgramRun run{stack::program_directory() / "crane",
                 {"run", short_run.string(), "--clock", "realtime", "--out", (directory / "out").string(),
                  "--domain", std::to_string(kDomain), "--crane", crane}};
  Watcher watcher{crane + "_run_" + std::to_string(run.pid())};
  const auto is = [](crane_SupervisorState state) {
    return [state](const auto& status) { return status.state == state; };
  };
  ASSERT_TRUE(watcher.until(is(crane_STATE_RUN), 30s));  // the first request has been sent
  ::kill(run.pid(), SIGSTOP);
  EXPECT_FALSE(watcher.until(is(crane_STATE_FAULT), 2s));
  ::kill(run.pid(), SIGCONT);
  EXPECT_EQ(run.wait(30s), 0);
  EXPECT_THAT(run.errors(), testing::ContainsRegex("warning: the request of 0.6 s was sent .* s late"));
  EXPECT_TRUE(std::filesystem::exists(directory / "out" / "run.csv"));
}

experiment::Scenario scenario(const TemporaryDirectory& directory, const std::string& name,
                              const std::string& moves) {
  const auto file = directory / name;
  recording::put_contents(file, "description = \"a test\"\nduration_s = 6\n" + moves);
  const auto rig = configuration::load_rig(stack::find_rig("emulated_servo_to_go"));
  return experiment::load_scenario(file, &rig);
}

experiments::RealtimeRunOptions on_the_emulated_board() {
  experiments::RealtimeRunOptions options;
  options.plant = stack::Plant::hardware;
  options.bus.domain = kDomain;
  options.bus.crane = crane_name();
  return options;
}

/// Without the place of the first run, the second bridge would measure [start], and the limits would lie
/// elsewhere on the rail.
TEST(RealtimeRuns, OnARealCraneBeginWhereTheRunBeforeHasEnded) {
  const TemporaryDirectory directory;
  experiments::RealtimeRuns runs{on_the_emulated_board()};
  const auto rig = stack::find_rig("emulated_servo_to_go");
  const auto there =
      runs.run(rig, "gain_scheduling_partial",
               scenario(directory, "there.toml", "[[move]]\nat_s = 0.1\ntrolley_position_m = 0.6\n"));
  const auto stays =
      runs.run(rig, "gain_scheduling_partial",
               scenario(directory, "stays.toml", "[[move]]\nat_s = 0.1\nslew_angle_rad = 0.1\n"));
  const auto trolley = [](const experiments::RealtimeRun& run) {
    return *run.table.find("trolley_position_m");
  };
  ASSERT_FALSE(trolley(there).empty());
  ASSERT_FALSE(trolley(stays).empty());
  EXPECT_NEAR(trolley(there).back(), 0.6, 0.02);
  EXPECT_NEAR(trolley(stays).front(), trolley(there).back(), 0.005);
  EXPECT_NEAR(trolley(stays).back(), trolley(there).back(), 0.02);
  const auto text = runs.difference_from_start(configuration::load_rig(rig));
  EXPECT_THAT(text,
              AllOf(testing::ContainsRegex("trolley at (0.59|0.6)"), testing::HasSubstr("([start] 0.3)")));
}

/// A program can be suspended between two runs. Another program can then move the crane and end.
TEST(RealtimeRuns, OnARealCraneEndWhenAnotherBridgeHasUsedTheBoard) {
  const TemporaryDirectory directory;
  const auto options = on_the_emulated_board();
  experiments::RealtimeRuns runs{options};
  const auto file = stack::find_rig("emulated_servo_to_go");
  const auto rests = scenario(directory, "rests.toml", "");
  (void)runs.run(file, "gain_scheduling_partial", rests);
  {
    const auto rig = configuration::load_rig(file);
    stack::LaunchOptions other;
    other.bus = options.bus;
    other.rig = file.string();
    stack::ChildProcesses children;
    const auto specs = stack::stack_with(options.plant);
    stack::launch_rig(children, rig, other);
    stack::launch(children, specs, other);
    bus::Bus bus{runtime::bus_options(options.bus, "test", crane_SOURCE_MONITOR, 0)};
    stack::wait_until_ready(children, specs, bus, 15s);
    children.stop();
  }
  EXPECT_THAT([&] { (void)runs.run(file, "gain_scheduling_partial", rests); },
              testing::ThrowsMessage<experiments::SessionError>(
                  testing::HasSubstr("another hardware bridge has used the board")));
}

}  // namespace
}  // namespace crane::system_test
