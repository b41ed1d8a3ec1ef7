// crane log and crane replay, started as by a user: exit codes, refusals, and protection of existing files.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <iostream>

#include "../replay/recorded_crane.hpp"
#include "../system/program_run.hpp"
#include "recording_export/hdf5_export.hpp"
#include "recording_export/matlab_export.hpp"
#include "stack/child_processes.hpp"

namespace crane::cli {
namespace {

using recording::contents_of;
using recording::put_contents;
using system_test::Ended;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

Ended crane(const std::vector<std::string>& arguments) {
  return system_test::run_program(stack::program_directory() / "crane", arguments);
}

class RecordingCommands : public testing::Test {
 protected:
  void SetUp() override {
    replay_test::RecordedCrane crane{directory_ / "run.mcap", "virginia_tech_tower",
                                     "gain_scheduling_partial"};
    crane.arm();
    crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {0.8, 0, 0}});
    crane.run(1);
    ticks_ = std::to_string(crane.finish());
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (directory_ / name).string(); }

  /// Names of all files of the directory.
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{path("")})
      names.push_back(entry.path().filename());
    return names;
  }

  recording::TemporaryDirectory directory_;
  std::string run_ = path("run.mcap"), ticks_;
};

/// Every command that writes a file: the words before and after the name of the file.
TEST_F(RecordingCommands, RefuseToOverwriteAFileWithoutForce) {
  ASSERT_EQ(crane({"log", "cut", run_, path("part.mcap"), "--to", "1"}).exit_code, 0);
  const auto out = path("precious");
  const std::vector<std::vector<std::string>> commands{
      {"log", "cut", run_, out, "--to", "1"},
      {"log", "merge", run_, path("part.mcap"), out},
      {"log", "repair", run_, "--out", out},
      {"log", "export", "csv", run_, "--out", out},
      {"log", "export", "csv", run_, "--topic", "crane/state", "--out", out},
      {"log", "export", "json", run_, "--topic", "crane/demand", "--out", out},
      {"log", "export", "hdf5", run_, "--topic", "demand", "--out", out},
      {"log", "export", "matlab", run_, "--topic", "demand", "--out", out},
      {"replay", run_, "--swap", "controller=delayed_1", "--out", out}};
  for (auto command : commands) {
    SCOPED_TRACE(testing::PrintToString(command));
    put_contents(out, "precious");
    const auto refused = crane(command);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(refused.errors, out + ": exists; choose another name or --force\n");
    EXPECT_EQ(refused.output, "");
    EXPECT_EQ(contents_of(out), "precious");

    command.emplace_back("--force");
    const auto forced = crane(command);
    EXPECT_EQ(forced.exit_code, 0) << forced.errors;
    EXPECT_GT(contents_of(out).size(), 1000U);
    std::filesystem::remove(out);

    command.pop_back();
    const auto written = crane(command);
    EXPECT_EQ(written.exit_code, 0) << written.errors;
    EXPECT_TRUE(std::filesystem::exists(out));
  }
}

TEST_F(RecordingCommands, RefuseToOverwriteTheFileOfTheDefaultName) {
  EXPECT_EQ(crane({"log", "repair", run_}).exit_code, 0);
  EXPECT_THAT(crane({"log", "repair", run_}).errors, HasSubstr("run.repaired.mcap: exists"));
  const std::vector<std::string> swap{"replay", run_, "--swap", "controller=lqr"};
  EXPECT_EQ(crane(swap).exit_code, 0);
  EXPECT_THAT(crane(swap).errors, HasSubstr("run.lqr.csv: exists"));
}

TEST_F(RecordingCommands, CutsOfARunAreMergedToARecordingThatIsReplayed) {
  ASSERT_EQ(crane({"log", "cut", run_, path("a.mcap"), "--to", "1.5"}).exit_code, 0);
  ASSERT_EQ(crane({"log", "cut", run_, path("b.mcap"), "--from", "1.5"}).exit_code, 0);
  ASSERT_EQ(crane({"log", "merge", path("b.mcap"), path("a.mcap"), path("both.mcap")}).exit_code, 0);
  const auto all = crane({"replay", path("both.mcap")});
  EXPECT_EQ(all.output, "equal bit for bit, " + ticks_ + " ticks\n") << all.errors;
  EXPECT_EQ(crane({"replay", path("a.mcap")}).output, "equal bit for bit, 150 ticks\n");
  const auto later = crane({"replay", path("b.mcap")});
  EXPECT_EQ(later.exit_code, 2);
  EXPECT_THAT(later.errors, HasSubstr("begins with tick 150"));
}

/// SciPy and h5py read the files; matio and the C interface of HDF5 wrote them.
TEST_F(RecordingCommands, ExportToHdf5AndMatlabTheValuesOfTheCsvExport) {
  const std::string python = "/usr/bin/python3";
  if (system_test::run_program(python, {"-c", "import h5py, scipy.io"}).exit_code != 0)
    GTEST_SKIP() << "needs python3-h5py and python3-scipy (deploy/install-dependencies)";
  const std::vector<std::string> topics{"crane/state",   "crane/reference",  "crane/tracking",
                                        "crane/demand",  "crane/anti_swing", "crane/command",
                                        "crane/request", "crane/supervisor"};
  for (auto topic : topics) {
    auto file = topic;
    std::ranges::replace(file, '/', '_');
    const auto csv = crane({"log", "export", "csv", run_, "--topic", topic, "--out", path(file + ".csv")});
    ASSERT_EQ(csv.exit_code, 0) << csv.errors;
  }
  for (const char* format : {"hdf5", "matlab"}) {
    const auto exported = crane({"log", "export", format, run_});
    ASSERT_EQ(exported.exit_code, 0) << exported.errors;
    EXPECT_THAT(exported.output,
                HasSubstr(std::string{"run."} + (format[0] == 'h' ? "h5" : "mat") + ": written"));
  }
  std::vector<std::string> arguments{CRANE_READ_EXPORTS, path("run.h5"), path("run.mat"), path(".")};
  arguments.insert(arguments.end(), topics.begin(), topics.end());
  const auto read = system_test::run_program(python, arguments);
  EXPECT_EQ(read.exit_code, 0) << read.errors;
  EXPECT_THAT(read.output, testing::ContainsRegex("^[0-9]{5,} values are equal"));
}

TEST_F(RecordingCommands, LeaveNoPartOfAnExportThatFails) {
  for (const char* format : {"hdf5", "matlab"}) {
    const auto failed = crane({"log", "export", format, run_, "--out", path("missing/run.out")});
    EXPECT_EQ(failed.exit_code, 1);
    EXPECT_THAT(failed.errors, HasSubstr("missing/run.out: cannot "));
    const auto unknown = crane({"log", "export", format, run_, "--topic", "nothing", "--out", path("a.out")});
    EXPECT_EQ(unknown.exit_code, 1);
    EXPECT_THAT(unknown.errors, HasSubstr("the recording has no topic 'nothing'; it has crane/state"));
    EXPECT_EQ(files(), std::vector<std::string>{"run.mcap"});
  }
}

/// The commands that write a file: none overwrites the recording that it reads, also with --force.
TEST_F(RecordingCommands, NeverOverwriteTheirRecording) {
  const auto before = contents_of(run_);
  for (std::vector<std::string> command : {std::vector<std::string>{"log", "export", "csv", run_, "--force"},
                                           {"log", "export", "csv", run_, "--topic", "state", "--force"},
                                           {"log", "export", "json", run_, "--force"},
                                           {"log", "export", "hdf5", run_, "--force"},
                                           {"log", "export", "matlab", run_, "--force"},
                                           {"replay", run_, "--swap", "controller=delayed_1", "--force"},
                                           {"scope", "--trigger", "state.header.tick > 10", "--file", run_},
                                           {"zone", "learn", "silo", run_, "--top", "1", "--force"},
                                           {"review", run_}}) {
    if (command[1] != "cut") command.emplace_back("--out");
    command.push_back(run_);
    SCOPED_TRACE(testing::PrintToString(command));
    const auto refused = crane(command);
    EXPECT_NE(refused.exit_code, 0);
    EXPECT_THAT(refused.errors, HasSubstr("is a file that the command reads"));
    EXPECT_EQ(contents_of(run_), before);
  }
}

/// In a gap, the hook may have gone around the obstacle outside the box.
TEST_F(RecordingCommands, LearnNoZoneFromARecordingWithAGap) {
  ASSERT_EQ(crane({"log", "cut", run_, path("before.mcap"), "--to", "0.5"}).exit_code, 0);
  ASSERT_EQ(crane({"log", "cut", run_, path("after.mcap"), "--from", "1"}).exit_code, 0);
  ASSERT_EQ(crane({"log", "merge", path("before.mcap"), path("after.mcap"), path("gap.mcap")}).exit_code, 0);
  const auto refused =
      crane({"zone", "learn", "silo", path("gap.mcap"), "--top", "1", "--out", path("rig.toml")});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors,
              testing::ContainsRegex("no position of the hook between 0.(49|50) s and 1.0[01] s"));
  EXPECT_FALSE(std::filesystem::exists(path("rig.toml")));
}

/// An earlier version wrote to FILE.partial.
TEST_F(RecordingCommands, ExplainsTheLastStateWithItsTickAndTheDamageOfTheRecording) {
  const auto last = "tick " + std::to_string(std::stoi(ticks_) - 1) + '\n';
  const auto intact = crane({"supervisor", "explain", "--state", run_});
  EXPECT_EQ(intact.exit_code, 0);
  EXPECT_THAT(intact.output, AllOf(StartsWith(last + "RUN\n"), HasSubstr("reset: refused")));
  EXPECT_EQ(intact.errors, "");
  const auto text = contents_of(run_);
  put_contents(path("cut.mcap"), text.substr(0, text.size() / 3));
  const auto cut = crane({"supervisor", "explain", "--state", path("cut.mcap")});
  EXPECT_EQ(cut.exit_code, 0) << cut.errors;
  EXPECT_THAT(cut.output, StartsWith("tick "));
  EXPECT_THAT(cut.errors, HasSubstr("the recording is damaged: a later state may be missing"));
}

TEST_F(RecordingCommands, LeaveFilesBesideTheirResultUnchanged) {
  const auto before = contents_of(run_);
  std::filesystem::rename(run_, path("a.mcap.partial"));
  const auto repaired = crane({"log", "repair", path("a.mcap.partial"), "--out", path("a.mcap")});
  EXPECT_EQ(repaired.exit_code, 0) << repaired.errors;
  EXPECT_EQ(contents_of(path("a.mcap.partial")), before);
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.mcap", "a.mcap.partial"));
}

TEST_F(RecordingCommands, FailWhenStandardOutputCannotBeWritten) {
  const auto failed =
      system_test::run_program("/bin/sh", {"-c", "exec \"$0\" log export csv \"$1\" > /dev/full",
                                           (stack::program_directory() / "crane").string(), run_});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.errors, HasSubstr("crane: standard output is incomplete"));
}

/// A limit of the size of files acts like a full disk. The library cleans up when the program exits.
TEST_F(RecordingCommands, AnExportToAFullDiskFailsWithItsReasonAndACleanExit) {
  using Write = void (*)(const std::filesystem::path&, recording::McapReader&, const std::string&);
  const auto write_and_exit = [&](Write write) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{10'000, 10'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      recording::McapReader reader{run_};
      write(path("full.out"), reader, "");
    } catch (const std::runtime_error& error) {
      std::cerr << error.what();
    }
    std::exit(3);
  };
  EXPECT_EXIT(write_and_exit(recording_export::write_hdf5), testing::ExitedWithCode(3),
              "full.out: cannot write: File too large");
  EXPECT_EXIT(write_and_exit(recording_export::write_matlab), testing::ExitedWithCode(3),
              "full.out: cannot write: .*(File too large|free space)");
  EXPECT_EQ(files(), std::vector<std::string>{"run.mcap"});
}

TEST_F(RecordingCommands, ReplayNamesTheDifferenceWithExitCode1) {
  replay_test::copy_changed(run_, path("changed.mcap"),
                            [](const recording::Message& message, std::vector<std::uint8_t>& data) {
                              if (message.channel->topic == "crane/demand" && message.sequence == 300)
                                data.at(76) ^= 1U;
                              return true;
                            });
  const auto found = crane({"replay", path("changed.mcap")});
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_THAT(found.output, HasSubstr("different: crane/demand of tick 300 (3 s): total_v[0]: recorded "));
  const auto json = crane({"replay", path("changed.mcap"), "--json"});
  EXPECT_EQ(json.exit_code, 1);
  EXPECT_THAT(json.output, HasSubstr(R"("tick": 300)"));
}

}  // namespace
}  // namespace crane::cli
