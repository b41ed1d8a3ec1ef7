// Commands that read and write files, as a user starts them: an input is never an output, and a selection
// without effect is refused.
#include <gmock/gmock.h>

#include <algorithm>

#include "../recording/temporary_directory.hpp"
#include "../system/program_run.hpp"
#include "crane/configuration/rig.hpp"
#include "stack/child_processes.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

using recording::contents_of;
using recording::put_contents;
using system_test::Ended;
using testing::HasSubstr;

Ended crane(const std::vector<std::string>& arguments) {
  return system_test::run_program(stack::program_directory() / "crane", arguments);
}

class FileCommands : public testing::Test {
 protected:
  FileCommands() { std::filesystem::create_directories(directory_ / "out"); }
  [[nodiscard]] std::string path(const std::string& name) const { return (directory_ / name).string(); }
  /// Writes a rig file that extends the tower.
  [[nodiscard]] std::string rig(const std::string& name) const {
    put_contents(path(name),
                 "extends = \"" + stack::find_rig("virginia_tech_tower").string() + "\"  # mine\n");
    return path(name);
  }
  /// Expects one line, exit code 2, and an unchanged input.
  static void expect_refused(const std::vector<std::string>& command, const std::string& input) {
    SCOPED_TRACE(testing::PrintToString(command));
    const auto before = contents_of(input);
    const auto refused = crane(command);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.errors, input + ": is a file that the command reads; give another name\n");
    EXPECT_EQ(contents_of(input), before);
  }
  static void expect_one_line(const std::vector<std::string>& command, const std::string& line) {
    SCOPED_TRACE(testing::PrintToString(command));
    const auto refused = crane(command);
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_THAT(refused.errors, HasSubstr(line));
    EXPECT_EQ(std::ranges::count(refused.errors, '\n'), 1) << refused.errors;
    EXPECT_EQ(refused.output, "");
  }

  recording::TemporaryDirectory directory_;
};

TEST_F(FileCommands, NeverOverwriteTheirRigFile) {
  const auto out = path("out");
  expect_refused({"run", "maneuver_1", "--in-process", "--rig", rig("out/rig.toml"), "--out", out},
                 path("out/rig.toml"));
  expect_refused({"tune", "--rig", rig("out/tuned.toml"), "--out", out}, path("out/tuned.toml"));
  expect_refused({"tune", "--hidden", path("out/tuned.toml"), "--out", out}, path("out/tuned.toml"));
  expect_refused(
      {"identify", "friction", "--axis", "trolley", "--rig", rig("out/identified.toml"), "--out", out},
      path("out/identified.toml"));
  put_contents(path("a.csv"), "time_s\n");
  expect_refused({"diagnose", "--rig", rig("out/extended.toml"), "--train", path("a.csv"), "--test",
                  path("a.csv"), "--out", out},
                 path("out/extended.toml"));
}

TEST_F(FileCommands, NeverOverwriteABaseOfTheirRigFile) {
  (void)rig("out/rig.toml");
  put_contents(path("mine.toml"), "extends = \"out/rig.toml\"\n");
  expect_refused({"run", "maneuver_1", "--in-process", "--rig", path("mine.toml"), "--out", path("out")},
                 path("out/rig.toml"));
}

TEST_F(FileCommands, AZoneIsRemovedIntoAnotherDirectory) {
  (void)rig("base.toml");
  put_contents(
      path("my.toml"),
      "extends = \"base.toml\"\n[clearance]\nload_radius_m = 0.1\nsuspension_height_m = 2.0\n"
      "[[zone]]\nname = \"mast\"\nshape = \"cylinder\"\nposition_x_m = -0.8\nradius_m = 0.2\ntop_m = 3\n");
  const auto removed =
      crane({"zone", "remove", "mast", "--rig", path("my.toml"), "--out", path("out/my.toml")});
  EXPECT_EQ(removed.exit_code, 0) << removed.errors;
  EXPECT_EQ(configuration::load_rig(path("out/my.toml")).clearance.load_radius_m, 0.1);
  expect_refused({"zone", "remove", "mast", "--rig", path("my.toml"), "--out", path("base.toml"), "--force"},
                 path("base.toml"));
}

TEST_F(FileCommands, ACampaignWithoutARunIsRefused) {
  expect_one_line({"campaign", "--hazard", "26"},
                  "--hazard 26: wall-clock jump: the campaign cannot inject it; "
                  "it is verified by tests/system (ClockJump.*)");
  expect_one_line({"campaign", "--hazard", "30"}, "it is verified by tests/recording");
  expect_one_line({"campaign", "--first-seed", "18446744073709551615", "--seeds", "12"},
                  "the last seed must be below 2^64 - 1");
  expect_one_line(
      {"campaign", "--hazard", "9", "--moment", "cruise", "--seeds", "1", "--log", "/nonexistent/x"},
      "/nonexistent/x: cannot write: No such file or directory");
}

TEST_F(FileCommands, OptionsWithoutEffectAreRefused) {
  put_contents(path("run.mcap"), "");
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--out", path("y.csv")},
                                                  {"--force"},
                                                  {"--processes", "--swap", "controller=pd"}}) {
    std::vector<std::string> command{"replay", path("run.mcap")};
    command.insert(command.end(), options.begin(), options.end());
    const auto refused = crane(command);
    EXPECT_EQ(refused.exit_code, 2) << testing::PrintToString(command);
    EXPECT_THAT(refused.errors, HasSubstr("--swap"));
  }
  expect_one_line({"run", "--compare", "--clock", "realtime"},
                  "--clock = realtime: cannot be combined with --compare");
}

/// The simulated board has no channels: the exchange would have no effect.
TEST_F(FileCommands, ATuningRefusesAHiddenCraneWithExchangedChannels) {
  const auto base = "extends = \"" + stack::find_rig("virginia_tech_tower").string() + "\"\n";
  put_contents(path("drives.toml"),
               base + "[drive.trolley]\ndac_channel = 1\n[drive.slew]\ndac_channel = 0\n");
  const auto drives = crane({"tune", "--hidden", path("drives.toml"), "--out", path("out")});
  EXPECT_EQ(drives.exit_code, 2);
  EXPECT_THAT(drives.errors, HasSubstr("drive.trolley.dac_channel = 1: must be 0 as in --rig"));
  put_contents(path("encoders.toml"), base + "[encoder.trolley]\nchannel = 1\n[encoder.slew]\nchannel = 0\n");
  const auto encoders = crane({"tune", "--hidden", path("encoders.toml"), "--out", path("out")});
  EXPECT_EQ(encoders.exit_code, 2);
  EXPECT_THAT(encoders.errors, HasSubstr("encoder.trolley.channel = 1: must be 0 as in --rig"));
}

}  // namespace
}  // namespace crane::cli
