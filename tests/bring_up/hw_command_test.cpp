// crane hw as a program: output, exit codes, files.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "../recording/temporary_directory.hpp"
#include "../system/program_run.hpp"
#include "crane/boards/linked_rig.hpp"
#include "stack/data_files.hpp"

namespace crane::bring_up::test {
namespace {

using system_test::ProgramRun;
using system_test::run_program;

class Hw : public testing::Test {
 protected:
  static std::filesystem::path program(const std::string& name) {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
  }
  system_test::Ended hw(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "hw");
    return run_program(program("crane"), arguments);
  }
  /// A rig file that extends the emulated tower.
  std::string rig(const std::string& name, const std::string& text) {
    const auto file = directory_ / (name + ".toml");
    recording::put_contents(
        file, "extends = \"" + stack::find_rig("emulated_servo_to_go").string() + "\"\n" + text);
    return file;
  }
  recording::TemporaryDirectory directory_;
  const std::string tower_ = "emulated_servo_to_go";
};

TEST_F(Hw, ListsAndProbesAsJson) {
  const auto listed = hw({"list", "--rig", tower_, "--json"});
  EXPECT_EQ(listed.exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(listed.output)["rig"]["encoders"].size(), 5U);
  const auto probed = hw({"probe", "--rig", tower_, "--json"});
  EXPECT_EQ(probed.exit_code, 0);
  const auto found = nlohmann::json::parse(probed.output);
  EXPECT_EQ(found["board"], "servo_to_go model 1");
  EXPECT_EQ(found["counters"][0]["raw_counts"], 188976);  // 0.3 m
  EXPECT_EQ(found["relay_dropped"], true);
}

TEST_F(Hw, SelftestPrintsOneLinePerFaultAndEndsWithExitCodeOne) {
  EXPECT_EQ(hw({"selftest", "--rig", tower_}).exit_code, 0);
  const auto wired = rig("swapped", "[drive.trolley]\ndac_channel = 1\n[drive.slew]\ndac_channel = 0\n");
  const auto wrong = hw({"selftest", "--rig", tower_, "--wired-as", wired});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(wrong.output,
            "drives_swapped: the trolley and slew drives are swapped (analog outputs 0 and 1)\n");
  const auto json = hw({"selftest", "--rig", tower_, "--wired-as", wired, "--json"});
  EXPECT_EQ(nlohmann::json::parse(json.output)["findings"][0]["subject"], "trolley, slew");
}

TEST_F(Hw, SelftestRefusesVoltsThatAreNoNumberBecauseNoDriveWouldBeTested) {
  for (const char* volts : {"nan", "-nan", "inf", "1e308", "0.99", "5.01", "3V"}) {
    const auto refused = hw({"selftest", "--rig", tower_, "--volts", volts});
    EXPECT_EQ(refused.exit_code, 2) << volts << refused.output;
    EXPECT_NE(refused.errors.find("must be a number in [1, 5]"), std::string::npos) << refused.errors;
  }
}

/// Wrong signs: calibration, then a self-test with the calibrated file.
TEST_F(Hw, CalibratesAWronglyWiredRigSoThatItPasses) {
  const auto wired =
      rig("wired",
          "[drive.trolley]\nsign = -1\n[encoder.slew]\nsign = -1\n[encoder.swing_radial]\nsign = -1\n"
          "[encoder.hoist]\nsign = -1\n");
  EXPECT_EQ(hw({"selftest", "--rig", tower_, "--wired-as", wired}).exit_code, 1);
  const auto answers = directory_ / "answers";
  recording::put_contents(answers, "n\n\n\ny\n\n\ny\n\n\n");
  const std::string out = directory_ / "calibrated.toml";
  const auto calibrated =
      hw({"calibrate", "--rig", tower_, "--wired-as", wired, "--answers", answers, "--out", out});
  EXPECT_EQ(calibrated.exit_code, 0) << calibrated.errors;
  EXPECT_EQ(hw({"selftest", "--rig", out, "--wired-as", wired}).exit_code, 0);
}

TEST_F(Hw, RefusesInvalidArguments) {
  const auto other = rig("other", "name = \"other\"\n");
  const auto refused = hw({"calibrate", "--rig", tower_, "--out", other});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("calibration of another rig"), std::string::npos) << refused.errors;
  const auto nowhere = hw({"calibrate", "--rig", tower_, "--out", directory_ / "nowhere" / "x.toml"});
  EXPECT_EQ(nowhere.exit_code, 2);
  EXPECT_EQ(nowhere.output, "") << "asked, and moved, before it said that it cannot write";
  EXPECT_EQ(hw({"jog", "--rig", tower_, "--axis", "trolley", "--volts", "9"}).exit_code, 2);
  EXPECT_EQ(hw({"jog", "--rig", tower_, "--axis", "swing_radial", "--volts", "2"}).exit_code, 2);
  EXPECT_EQ(hw({"probe", "--rig", "gantry"}).exit_code, 2);  // board = simulated
  EXPECT_EQ(hw({"probe"}).exit_code, 2);
  const auto empty = directory_ / "empty";
  recording::put_contents(empty, "");
  EXPECT_EQ(hw({"calibrate", "--rig", tower_, "--answers", empty, "--out", directory_ / "x.toml"}).exit_code,
            1);
  EXPECT_FALSE(std::filesystem::exists(directory_ / "x.toml"));
}

/// A rig in a separate process: real time, only one user at a time, Ctrl-C.
TEST_F(Hw, UsesABoardExclusivelyAndEndsOnCtrlC) {
  const auto crane = "hw_" + std::to_string(::getpid());
  ProgramRun emulated{program("crane_emulated_rig"),
                      {"--rig", stack::find_rig(tower_).string(), "--crane", crane, "--priority", "0"}};
  const auto lines = bridge::shared_lines_name(crane, 0);
  {
    const bridge::LinkedRig first{lines};
    const auto second = hw({"probe", "--rig", tower_, "--crane", crane});
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_NE(second.errors.find("another hardware bridge uses this board"), std::string::npos)
        << second.errors;
  }
  const bridge::RigMonitor monitor{lines};
  ProgramRun user{program("crane"), {"hw", "selftest", "--rig", tower_, "--crane", crane}};
  while (monitor.lines().relay_dropped_ns == 0 && !user.wait(std::chrono::milliseconds{1})) {
  }  // the relay has closed once: the command is running
  user.send(SIGINT);
  EXPECT_EQ(user.wait(std::chrono::seconds{5}), 1);
  EXPECT_NE(user.errors().find("interrupted; 0 V, brakes closed"), std::string::npos) << user.errors();
  for (const auto& code : monitor.lines().codes) EXPECT_EQ(code, 0x1000);
  EXPECT_EQ(monitor.lines().outputs, 0);
}

/// A drive with reversed wiring, and a rig file that states this wiring, behave like the original crane.
TEST_F(Hw, ADriveWithANegativeSignRunsTheSameManeuver) {
  for (const std::string plant : {"sim", "hardware"}) {
    const auto run = [&](const std::string& file) {
      return run_program(program("crane"), {"run", "maneuver_1", "--in-process", "--plant", plant, "--rig",
                                            file, "--out", directory_ / "run"});
    };
    const auto straight = run(rig("straight", ""));
    const auto reversed = run(rig("reversed", "[drive.trolley]\nsign = -1\n[drive.slew]\nsign = -1\n"));
    EXPECT_EQ(straight.exit_code, 0);
    EXPECT_EQ(reversed.output, straight.output) << plant;
  }
}

}  // namespace
}  // namespace crane::bring_up::test
