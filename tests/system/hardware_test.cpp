/// The whole hardware path with an emulated Servo-to-Go card: the maneuvers, compared with the simulated
/// plant, and a bridge that ends or hangs at full speed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <iostream>

#include "../recording/temporary_directory.hpp"
#include "crane/boards/linked_rig.hpp"
#include "crane/bridge/bridge.hpp"
#include "crane/bridge/component.hpp"
#include "crane/runtime/in_process.hpp"
#include "experiments/experiment_run.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using recording::contents_of;
using recording::TemporaryDirectory;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 64;
constexpr const char* kRig = "emulated_servo_to_go";
constexpr std::int64_t kBound_ns = 50'000'000;

experiments::ExperimentOptions options_for(const std::string& scenario,
                                           const std::filesystem::path& directory) {
  experiments::ExperimentOptions options;
  options.scenario = stack::find_scenario(scenario);
  options.rig = stack::find_rig(kRig);
  options.directory = directory;
  options.picture = false;
  options.bus.domain = kDomain;
  options.bus.crane = crane_name();
  return options;
}

class HardwareManeuver : public testing::TestWithParam<const char*> {};

/// The emulated card has the same counts and codes as the simulated plant, so that only the name of the clock
/// master may differ. Equal bytes also imply that the difference is below the quantisation.
TEST_P(HardwareManeuver, ThroughTheBoardIsTheSameAsOnTheSimulatedPlant) {
  const TemporaryDirectory directory;
  auto options = options_for(GetParam(), directory / "simulated");
  options.in_process = true;
  const auto simulated = experiments::run_experiment(options);
  options.plant = stack::Plant::hardware;
  options.directory = directory / "hardware";
  const auto hardware = experiments::run_experiment(options);
  EXPECT_TRUE(hardware.outcome.completed) << hardware.outcome.stopped_because;
  ASSERT_TRUE(hardware.metrics.settling_time_s && simulated.metrics.settling_time_s);
  std::cout << GetParam() << ": settled after " << *hardware.metrics.settling_time_s
            << " s through the board, " << *simulated.metrics.settling_time_s
            << " s on the simulated plant\n";
  EXPECT_EQ(*hardware.metrics.settling_time_s, *simulated.metrics.settling_time_s);
  EXPECT_TRUE(contents_of(directory / "hardware" / "run.csv") ==
              contents_of(directory / "simulated" / "run.csv"));
}

INSTANTIATE_TEST_SUITE_P(Dissertation, HardwareManeuver,
                         testing::Values("maneuver_1", "maneuver_2", "maneuver_3", "disturbance_kick"),
                         [](const auto& test) { return std::string{test.param}; });

TEST(HardwareLockstep, ARigInASeparateProcessGivesTheSameBytesAsARigInTheBridge) {
  const TemporaryDirectory directory;
  auto options = options_for("maneuver_1", directory / "processes");
  options.plant = stack::Plant::hardware;
  EXPECT_TRUE(experiments::run_experiment(options).outcome.completed);
  options.in_process = true;
  options.directory = directory / "in_process";
  EXPECT_TRUE(experiments::run_experiment(options).outcome.completed);
  for (const auto* file : {"run.csv", "recording.mcap"})
    EXPECT_TRUE(contents_of(directory / "processes" / file) == contents_of(directory / "in_process" / file))
        << file;
}

/// Codes of the converters of trolley and jib.
std::array<int, 2> codes(const bridge::RigMonitor& monitor) {
  return {monitor.lines().codes[0].load(), monitor.lines().codes[1].load()};
}

class BridgeDeath : public testing::TestWithParam<int> {};

TEST_P(BridgeDeath, AtFullSpeedClosesTheBrakesWithin50MsOfTheLastToggle) {
  RunningStack running{kDomain, kRig, stack::Plant::hardware};
  const bridge::RigMonitor monitor{bridge::shared_lines_name(running.bus_options().crane, kDomain)};
  const auto zero_v = codes(monitor);
  running.session().arm();
  running.session().request(
      {.kind = crane_REQUEST_MOVE, .selected = {true, true, false}, .target = {1.0, 1.5, 0}}, "move");
  ASSERT_TRUE(running.until(
      [&] {
        if (running.observer().states().empty()) return false;
        const auto& state = running.observer().states().back();
        return std::abs(state.trolley_speed_mps) > 0.3 && std::abs(state.slew_speed_radps) > 0.5;
      },
      5s));
  const auto signal_ns = runtime::monotonic_ns();
  running.send("hardware_bridge", GetParam());
  ASSERT_TRUE(running.until([&] { return monitor.lines().brakes_closed_ns > signal_ns; }, 2s));
  const auto toggled_ns = monitor.lines().toggled_ns.load();
  const auto ms = [toggled_ns](std::int64_t at_ns) { return static_cast<double>(at_ns - toggled_ns) * 1e-6; };
  std::cout << "after the last toggle: relay open " << ms(monitor.lines().relay_dropped_ns)
            << " ms, brakes closed " << ms(monitor.lines().brakes_closed_ns) << " ms\n";
  EXPECT_LE(monitor.lines().brakes_closed_ns - toggled_ns, kBound_ns);
  const bool caught = std::ranges::count(std::array{SIGINT, SIGTERM, SIGHUP, SIGQUIT}, GetParam()) > 0;
  if (caught) {
    EXPECT_EQ(codes(monitor), zero_v) << "the volts stayed";
  }
}

// The first four signals are caught and end the process in order; for the others only the relay acts.
INSTANTIATE_TEST_SUITE_P(By, BridgeDeath,
                         testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGKILL, SIGSTOP, SIGABRT,
                                         SIGSEGV),
                         [](const auto& test) { return "SIG" + std::string{::sigabbrev_np(test.param)}; });

TEST(BridgeProcess, ContinuesWhenItsTerminalIsClosed) {
  RunningStack running{kDomain, kRig, stack::Plant::hardware};
  running.session().arm();
  running.send("hardware_bridge", SIGPIPE);
  running.forget();
  running.listen(500ms);
  ASSERT_GT(running.observer().states().size(), 30U);
  EXPECT_EQ(running.observer().states().back().latch_reason, crane_LATCH_NONE);
}

TEST(BridgeProcess, LeavesZeroVoltsAndClosedBrakesWhenCraneUpIsKilled) {
  const std::vector<std::string> on_this_crane{"--domain", std::to_string(kDomain), "--crane", crane_name()};
  auto arguments = on_this_crane;
  arguments.insert(arguments.begin(), {"up", "--plant", "hardware", "--rig", kRig});
  ProgramRun up{stack::program_directory() / "crane", arguments};
  ASSERT_TRUE(up.wait_for("is up", 15s)) << up.errors();
  const bridge::RigMonitor monitor{bridge::shared_lines_name(crane_name(), kDomain)};
  const auto zero_v = codes(monitor);
  runtime::BusOptions options;
  options.domain = kDomain;
  options.crane = crane_name();
  bus::Bus bus{runtime::bus_options(options, "system_test", crane_SOURCE_OPERATOR, 0)};
  experiments::RealtimeSession session{bus, [] {}};
  session.wait_for(crane_STATE_LOCKED, 5s);
  const std::uint16_t closed = monitor.lines().outputs;
  session.arm();
  ASSERT_NE(monitor.lines().outputs, closed);
  const auto children = processes_with(crane_name());
  up.send(SIGKILL);
  EXPECT_TRUE(wait_for_end(children, 5s));
  EXPECT_EQ(codes(monitor), zero_v);
  // the emulated rig ends, too: its lines keep the levels of the bridge
  EXPECT_EQ(monitor.lines().outputs, closed);
}

/// The next start of the bridge sets the encoders to [start], wherever the axes stand.
TEST(CraneUp, OnARealCraneStatesAtItsEndWhichAxesDoNotStandAtTheStart) {
  for (const bool moves : {true, false}) {
    ProgramRun up{stack::program_directory() / "crane",
                  {"up", "--plant", "hardware", "--rig", kRig, "--domain", std::to_string(kDomain), "--crane",
                   crane_name(), "--no-black-box"}};
    ASSERT_TRUE(up.wait_for("is up", 15s)) << up.errors();
    runtime::BusOptions options;
    options.domain = kDomain;
    options.crane = crane_name();
    bus::Bus bus{runtime::bus_options(options, "system_test", crane_SOURCE_OPERATOR, 0)};
    experiments::RealtimeSession session{bus, [] {}};
    session.wait_for(crane_STATE_LOCKED, 5s);
    if (moves) {
      session.arm();
      (void)session.move_to({true, false, false}, {0.6, 0, 0}, 20s);
      session.disarm();
    }
    up.send(SIGINT);
    EXPECT_EQ(up.wait(10s), 0);
    const auto statement =
        testing::ContainsRegex("the axes do not stand at \\[start\\]: trolley at (0.59|0.6).*0.3");
    if (moves)
      EXPECT_THAT(up.errors(), testing::AllOf(statement, testing::Not(HasSubstr("brake of"))));
    else
      EXPECT_THAT(up.errors(), testing::Not(HasSubstr("stand at [start]")));
  }
}

TEST(BridgeProcess, EndsWithItsParentDespiteFileCapabilities) {
  const int not_the_parent = 1;
  const auto ended =
      run_program(stack::program_directory() / "crane_hardware_bridge",
                  {"--rig", stack::find_rig(kRig).string(), "--domain", std::to_string(kDomain), "--crane",
                   crane_name(), "--parent", std::to_string(not_the_parent)});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.errors, HasSubstr("has ended"));
}

class HardwareStart : public testing::Test {
 protected:
  [[nodiscard]] static Ended crane(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--domain", std::to_string(kDomain), "--crane", crane_name()});
    return run_program(stack::program_directory() / "crane", arguments);
  }
  recording::TemporaryDirectory directory_;
};

TEST_F(HardwareStart, WithoutAHardwareBoardIsRefusedWithTheListOfBoards) {
  recording::put_contents(directory_ / "rig.toml",
                          "extends = \"" + stack::find_rig(kRig).string() + "\"\nboard = \"simulated\"\n");
  const auto ended = crane({"up", "--plant", "hardware", "--rig", (directory_ / "rig.toml").string()});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, testing::AllOf(HasSubstr("board = simulated"), HasSubstr("servo_to_go"),
                                           HasSubstr("emulated"), HasSubstr("--plant sim")));
}

TEST_F(HardwareStart, ALockstepRunOnARealCraneIsRefused) {
  const auto ended = crane({"run", "maneuver_1", "--plant", "hardware", "--rig", "virginia_tech_tower",
                            "--out", (directory_ / "out").string()});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors, HasSubstr("lockstep needs board = \"emulated\""));
}

TEST(BridgeInLockstep, IsRefusedOnABoardThatDoesNotSimulateTime) {
  class Real final : public bridge::Board {
   public:
    [[nodiscard]] std::string_view name() const override { return "real"; }
    [[nodiscard]] bridge::Inputs read() override { return {}; }
    std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs) override {
      return outputs.drive_v;
    }
    void make_safe() noexcept override {}
    void advance_to(std::int64_t /*time_ns*/) override {}
  };
  const auto rig = configuration::load_rig(stack::find_rig(kRig));
  auto spec = bridge::hardware_bridge_spec();
  spec.make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
    return std::make_unique<bridge::Bridge>(context, std::make_unique<Real>());
  };
  bus::Bus bus{runtime::memory_options(bus::make_memory_network(), "bridge", crane_SOURCE_BRIDGE)};
  const auto& none = *control::find_controller("none");
  EXPECT_NO_THROW((runtime::HostedComponent{bus, spec, rig, none, runtime::Clock::realtime}));
  try {
    runtime::HostedComponent{bus, spec, rig, none, runtime::Clock::lockstep};
    FAIL() << "accepted";
  } catch (const configuration::ConfigurationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--clock realtime"));
  }
}

TEST_F(HardwareStart, ABridgeWithoutItsRigNamesTheProgramToStart) {
  const auto ended = run_program(stack::program_directory() / "crane_hardware_bridge",
                                 {"--rig", stack::find_rig(kRig).string(), "--domain",
                                  std::to_string(kDomain), "--crane", crane_name()});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.errors, HasSubstr("start crane_emulated_rig"));
}

}  // namespace
}  // namespace crane::system_test
