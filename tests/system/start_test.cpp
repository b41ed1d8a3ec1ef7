/// The `crane` command as a user starts it: bad input, missing programs and disk space, the end of a stack.
/// Each case has one clear message and the right exit code, and leaves no process.
#include <algorithm>
#include <csignal>
#include <ctime>

#include "crane/security/keys.hpp"
#include "start_fixture.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// The tool cannot join the bus. The stack continues after the end of its keys.
TEST_F(Start, AStopWithExpiredOrWithoutKeysStatesHowToStopTheCraneWithoutTheBus) {
  constexpr std::int64_t kDay_s = 24 * 3600;
  const std::int64_t now_s = std::time(nullptr);
  security::make(directory_ / "expired", {now_s - 3 * kDay_s, now_s - kDay_s});
  for (const char* keys : {"expired", "deleted"})
    for (const char* command : {"stop", "estop", "disarm"}) {
      const auto ended = crane({command, "--secure", (directory_ / keys).string()});
      EXPECT_EQ(ended.exit_code, kBadInput) << command;
      EXPECT_THAT(ended.errors,
                  AllOf(HasSubstr(keys), HasSubstr("to stop the crane without the bus, end `crane "
                                                   "up` (Ctrl-C, or `systemctl stop crane`)")));
    }
}

TEST_F(Start, WithKeysThatEndSoonNamesFileAndDate) {
  security::make(directory_ / "keys", security::valid_for(10));
  const auto keys = (directory_ / "keys").string();
  const auto date = security::utc_of(security::ends(keys).front().until_s);
  ProgramRun up{stack::program_directory() / "crane",
                on_this_crane({"up", "--secure", keys, "--no-black-box", "--clock", "lockstep"})};
  EXPECT_TRUE(up.wait_for("is up", 30s)) << up.errors();
  EXPECT_THAT(up.errors(), AllOf(HasSubstr(keys), HasSubstr("ends on " + date)));
  up.send(SIGINT);
  EXPECT_EQ(up.wait(20s), 0);
  const auto check = run_program(stack::program_directory() / "crane", {"keys", "check", keys});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_THAT(check.output, HasSubstr("all usable until " + date));
  EXPECT_THAT(check.errors, HasSubstr("ends on " + date));
}

/// Such a period leaves the processes of the loop no time.
TEST_F(Start, InRealTimeWithAPeriodBelowOneMillisecondIsRefusedByCraneUpAndByEachProcess) {
  const auto rig = rig_file("period_s = 1e-4\n");
  const auto refusal = HasSubstr("rig.toml: period_s = 1e-04: must be at least 0.001 in real time");
  for (const auto& arguments : {std::vector<std::string>{"up", "--rig", rig, "--no-black-box"},
                                {"up", "--rig", rig, "--no-black-box", "--in-process"}}) {
    const auto up = crane(arguments);
    EXPECT_EQ(up.exit_code, kBadInput);
    EXPECT_THAT(up.errors, refusal);
  }
  for (const char* program : {"crane_tracking", "crane_plant", "crane_supervisor"}) {
    const auto ended = run_program(stack::program_directory() / program, on_this_crane({"--rig", rig}));
    EXPECT_EQ(ended.exit_code, kBadInput) << program;
    EXPECT_THAT(ended.errors, refusal) << program;
  }
}

TEST_F(Start, AnUnknownKeyInARigFileIsNamedWithItsLineAndTheKeyThatWasMeant) {
  const auto rig = rig_file("[plant]\nload_mas_kg = 2\n");
  for (const auto& arguments :
       {std::vector<std::string>{"up", "--rig", rig},
        std::vector<std::string>{"run", "maneuver_1", "--rig", rig, "--out", out()}}) {
    const auto ended = crane(arguments);
    EXPECT_EQ(ended.exit_code, kBadInput);
    EXPECT_THAT(ended.errors,
                HasSubstr("rig.toml:3: plant.load_mas_kg = 2: unknown key; did you mean load_mass_kg"));
    EXPECT_EQ(lines_in(ended.errors), 1U) << ended.errors;
  }
}

TEST_F(Start, AnUnknownUnitIsRefusedWithTheRightOne) {
  const auto rig = crane({"up", "--rig", rig_file("[drive.trolley]\nlow_limit_cm = 5\n")});
  EXPECT_EQ(rig.exit_code, kBadInput);
  EXPECT_THAT(rig.errors,
              HasSubstr("rig.toml:3: drive.trolley.low_limit_cm = 5: unit must be m: low_limit_m"));

  const auto move = crane({"move", "--slew", "90grad"});
  EXPECT_EQ(move.exit_code, kBadInput);
  EXPECT_THAT(move.errors, AllOf(HasSubstr("'grad'"), HasSubstr("rad (default), deg")));
}

TEST_F(Start, OptionsOfARecordingOrADashboardThatIsNotStartedAreRefused) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--record-quota", "1GB"},
                                               {"--record-split-every", "1s"},
                                               {"--dashboard-port", "8000"}}) {
    std::vector<std::string> command{"up"};
    command.insert(command.end(), more.begin(), more.end());
    const auto ended = crane(command);
    EXPECT_EQ(ended.exit_code, kBadInput);
    EXPECT_THAT(ended.errors, AllOf(HasSubstr(more[0]), HasSubstr("requires"))) << more[0];
  }
}

TEST_F(Start, AScenarioThatLeavesTheJibIsRefusedBeforeAnythingStarts) {
  const auto scenario =
      file("off.toml", "description = \"too far\"\n[[move]]\nat_s = 0.5\ntrolley_position_m = 2.0\n");
  const auto ended = crane({"run", scenario, "--out", out()});
  EXPECT_EQ(ended.exit_code, kBadInput);
  EXPECT_THAT(ended.errors, HasSubstr("off.toml:4: move[0].trolley_position_m = 2: must be in [0.19, 1.31]"));
  EXPECT_EQ(lines_in(ended.errors), 1U) << ended.errors;
}

TEST_F(Start, ARunInRealTimeRefusesOptionsThatNeedASimulation) {
  const auto ended = crane({"run", "maneuver_1", "--clock", "realtime", "--variants", "heavy_load", "--json",
                            "--in-process", "--out", out()});
  EXPECT_EQ(ended.exit_code, kBadInput);
  for (const char* text : {"cannot be combined with variant heavy_load of maneuver_1",
                           "cannot be combined with --json", "cannot be combined with --in-process"})
    EXPECT_THAT(ended.errors, HasSubstr(text));
  EXPECT_FALSE(std::filesystem::exists(out())) << "nothing has begun";
}

TEST_F(Start, AnUnknownControllerIsRefusedWithTheKnownControllers) {
  for (const auto& arguments :
       {std::vector<std::string>{"up"}, std::vector<std::string>{"run", "maneuver_1", "--out", out()}}) {
    auto with_controller = arguments;
    with_controller.insert(with_controller.end(), {"--controller", "nobody"});
    const auto ended = crane(with_controller);
    EXPECT_EQ(ended.exit_code, kBadInput);
    EXPECT_THAT(ended.errors, AllOf(HasSubstr("controller = nobody"), HasSubstr("gain_scheduling_partial"),
                                    HasSubstr("delayed_1"), HasSubstr("none")));
    EXPECT_EQ(lines_in(ended.errors), 1U) << ended.errors;
  }
}

TEST_F(Start, AnUnknownScenarioIsRefusedWithTheKnownScenarios) {
  const auto ended = crane({"run", "nothing", "--out", out()});
  EXPECT_EQ(ended.exit_code, kBadInput);
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("nothing"), HasSubstr("maneuver_1")));
}

TEST_F(Start, AMissingProgramIsNamedWithTheRemedy) {
  const auto copy = directory_ / "crane";
  std::filesystem::copy_file(stack::program_directory() / "crane", copy);
  for (const auto& arguments :
       {std::vector<std::string>{"up"}, std::vector<std::string>{"run", "maneuver_1", "--out", out()}}) {
    const auto ended = run_program(copy, on_this_crane(arguments));
    EXPECT_EQ(ended.exit_code, kFailed);
    EXPECT_THAT(ended.errors, AllOf(HasSubstr("crane_plant"), HasSubstr("build the project first")));
    EXPECT_EQ(lines_in(ended.errors), 1U) << ended.errors;
  }
}

TEST_F(Start, AProgramMissingInTheMiddleLeavesNoneOfTheOthersRunning) {
  for (const auto* program : {"crane", "crane_plant", "crane_trajectory_planner"})
    std::filesystem::copy_file(stack::program_directory() / program, directory_ / program);
  const auto ended = run_program(directory_ / "crane", on_this_crane({"up"}));
  EXPECT_EQ(ended.exit_code, kFailed);
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("crane_tracking"), HasSubstr("build the project first")));
}

/// A device that is always full replaces a full disk.
TEST_F(Start, AFullDiskEndsARunWithOneLine) {
  for (const auto* way : {"processes", "--in-process"}) {
    const auto directory = directory_ / way;
    std::filesystem::create_directory(directory);
    std::filesystem::create_symlink("/dev/full", directory / "recording.mcap");
    std::vector<std::string> arguments{"run", "maneuver_1", "--out", directory.string()};
    if (way == std::string{"--in-process"}) arguments.emplace_back(way);
    const auto ended = crane(arguments);
    EXPECT_EQ(ended.exit_code, kFailed) << way;
    EXPECT_THAT(ended.errors, HasSubstr("recording.mcap: cannot write: No space left on device")) << way;
    EXPECT_EQ(lines_in(ended.errors), 1U) << ended.errors;
    EXPECT_THAT(processes_with(crane_name()), IsEmpty()) << way;
  }
}

TEST_F(Start, WithTooFewOpenFilesIsRefusedWithTheReason) {
  std::string command = "ulimit -n 12; exec " + (stack::program_directory() / "crane").string();
  for (const auto& word : on_this_crane({"up", "--no-black-box"})) command += " " + word;
  const auto up = run_program("/bin/sh", {"-c", command});
  EXPECT_EQ(up.exit_code, kFailed);
  EXPECT_THAT(up.errors, AnyOf(HasSubstr("do 12 open files suffice"), HasSubstr("Too many open files")));
}

TEST_F(Start, AStackEndsAsAWholeWhenOneOfItsProcessesDies) {
  ProgramRun up{stack::program_directory() / "crane", on_this_crane({"up"})};
  ASSERT_TRUE(up.wait_for("is up with", 20s)) << up.errors();
  const auto mine = processes_with(crane_name());
  const auto tracking = processes_with("crane_tracking");
  std::vector<pid_t> both;
  std::set_intersection(mine.begin(), mine.end(), tracking.begin(), tracking.end(), std::back_inserter(both));
  ASSERT_EQ(both.size(), 1U);
  ::kill(both.front(), SIGKILL);
  EXPECT_EQ(up.wait(10s), kFailed);
  EXPECT_THAT(up.errors(), HasSubstr("tracking has ended: signal 9"));
}

TEST_F(Start, AStackDoesNotOutliveItsCommand) {
  ProgramRun up{stack::program_directory() / "crane", on_this_crane({"up"})};
  ASSERT_TRUE(up.wait_for("is up with", 20s)) << up.errors();
  const auto all = processes_with(crane_name());
  ASSERT_EQ(all.size(), 8U);  // the command, six processes of the loop and the black box
  up.send(SIGKILL);
  EXPECT_EQ(up.wait(5s), 128 + SIGKILL);
  EXPECT_TRUE(wait_for_end(all, 5s));
}

}  // namespace
}  // namespace crane::system_test
