// crane record beside a running stack: parts, quota, losses, deleted files, a killed recorder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <map>

#include "../recording/temporary_directory.hpp"
#include "crane/recording/loss.hpp"
#include "crane/recording/mcap_edit.hpp"
#include "crane/recording/parts.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using recording::McapReader;
using recording::part_file;
using recording::parts_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint32_t kDomain = 85;
constexpr auto kPatience = 20s;
const auto kCrane = stack::program_directory() / "crane";

Ended crane(const std::vector<std::string>& arguments) { return run_program(kCrane, arguments); }

/// Ticks of the recorded crane/state, in the order of log time.
std::vector<std::uint32_t> ticks_in(const std::filesystem::path& recording) {
  std::vector<std::uint32_t> ticks;
  McapReader reader{recording};
  reader.for_each({.topics = {"crane/state"}}, [&](const recording::Message& message) {
    ticks.push_back(message.sequence);
    return true;
  });
  return ticks;
}

/// Number of ticks that are missing between the first and the last.
std::uint64_t missing_in(std::vector<std::uint32_t> ticks) {
  std::ranges::sort(ticks);
  ticks.erase(std::ranges::unique(ticks).begin(), ticks.end());
  return ticks.empty() ? 0 : ticks.back() - ticks.front() + 1 - ticks.size();
}

class Record : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> arguments(std::vector<std::string> more,
                                                   const std::string& vendor = "fastdds") const {
    more.insert(more.begin(), {"record", run_.string()});
    auto bus = stack_.bus_options();
    bus.vendor = vendor;
    const auto where = runtime::arguments(bus);
    more.insert(more.end(), where.begin(), where.end());
    return more;
  }
  /// Waits until `condition` holds, while the stack runs.
  bool until(const std::function<bool()>& condition) { return stack_.until(condition, kPatience); }
  [[nodiscard]] std::uintmax_t size_of(const std::filesystem::path& file) const {
    std::error_code none;
    const auto bytes = std::filesystem::file_size(file, none);
    return none ? 0 : bytes;
  }

  RunningStack stack_{kDomain, "virginia_tech_tower"};
  recording::TemporaryDirectory directory_;
  std::filesystem::path run_ = directory_ / "run.mcap";
};

TEST_F(Record, SplitsByTimeIntoSelfContainedPartsWithoutLosingATick) {
  ProgramRun recorder{kCrane, arguments({"--split-every", "1s", "--rig", "virginia_tech_tower"})};
  ASSERT_TRUE(until([&] { return parts_of(run_).size() >= 4; }));
  recorder.send(SIGINT);
  ASSERT_EQ(recorder.wait(kPatience), 0) << recorder.errors();
  EXPECT_THAT(recorder.output(), HasSubstr("parts"));

  const auto parts = parts_of(run_);
  for (const auto& part : parts) {
    EXPECT_THAT(recording::check(part.file).problems, IsEmpty());
    McapReader reader{part.file};
    ASSERT_EQ(reader.attachments().size(), 1U);
    EXPECT_EQ(reader.attachments().front().name, "rig.toml");
    EXPECT_LT(reader.last_time_ns() - reader.first_time_ns(), 1'000'000'000);
  }
  const auto ticks = ticks_in(run_);
  EXPECT_GT(ticks.size(), 250U);
  EXPECT_EQ(missing_in(ticks), 0U);
  EXPECT_TRUE(std::ranges::is_sorted(ticks));

  const auto checked = crane({"log", "check", run_.string()});
  EXPECT_EQ(checked.exit_code, 0);
  EXPECT_THAT(checked.output, HasSubstr("intact, none reported missing"));
  const auto joined = (directory_ / "joined.mcap").string();
  EXPECT_EQ(crane({"log", "merge", run_.string(), joined}).exit_code, 0);
  EXPECT_EQ(ticks_in(joined), ticks);
  const auto table = crane({"log", "export", "csv", run_.string()});
  EXPECT_EQ(std::ranges::count(table.output, '\n'), static_cast<std::ptrdiff_t>(ticks.size() + 1));
  EXPECT_EQ(crane({"log", "export", "csv", joined}).output, table.output);
}

TEST_F(Record, RefusesToOverwriteAnEarlierRecordingOrItsParts) {
  recording::put_contents(part_file(run_, 7), "precious");
  const auto refused = crane(arguments({"--split-every", "1s", "--duration", "1"}));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("run_000007.mcap: exists; choose another name or --force"));
  EXPECT_EQ(recording::contents_of(part_file(run_, 7)), "precious");
  const auto forced = crane(arguments({"--split-every", "1s", "--duration", "1", "--force"}));
  EXPECT_EQ(forced.exit_code, 0) << forced.errors;
  EXPECT_EQ(parts_of(run_).front().number, 1U);
  EXPECT_THAT(recording::check(run_).problems, IsEmpty());
}

/// The samples that the writers no longer keep are lost to a recorder that stood still: the recording states
/// their number.
class RecordLosses : public Record, public testing::WithParamInterface<const char*> {};

TEST_P(RecordLosses, OfDdsAreWrittenWithTopicNumberAndTime) {
  ProgramRun recorder{kCrane, arguments({}, GetParam())};
  ASSERT_TRUE(until([&] { return size_of(run_) > 50'000; }));
  recorder.send(SIGSTOP);
  stack_.listen(4s);
  recorder.send(SIGCONT);
  const auto size = size_of(run_);
  ASSERT_TRUE(until([&] { return size_of(run_) > size + 50'000; }));
  recorder.send(SIGINT);
  ASSERT_EQ(recorder.wait(kPatience), 0) << recorder.errors();

  const auto missing = missing_in(ticks_in(run_));
  McapReader reader{run_};
  const auto checked = crane({"log", "check", run_.string()});
  EXPECT_EQ(checked.exit_code, 0) << "the file is intact";
  std::uint64_t stated = 0;
  for (const auto& loss : recording::losses_in(reader)) {
    if (loss.topic != "crane/state") continue;
    stated += loss.samples;
    EXPECT_THAT(checked.output, HasSubstr("missing: crane/state: " + std::to_string(loss.samples)));
    EXPECT_GE(loss.from_ns, reader.first_time_ns());
    EXPECT_LE(loss.until_ns, reader.last_time_ns());
  }
  EXPECT_EQ(stated, missing);
  EXPECT_GT(missing, 0U);
}
INSTANTIATE_TEST_SUITE_P(Vendors, RecordLosses, testing::Values("fastdds", "cyclone"),
                         [](const auto& tested) { return std::string{tested.param}; });

TEST_F(Record, ContinuesInANewFileWhenItsFileIsDeleted) {
  ProgramRun recorder{kCrane, arguments({"--split-every", "1h"})};
  ASSERT_TRUE(until([&] { return size_of(part_file(run_, 1)) > 50'000; }));
  std::filesystem::remove(part_file(run_, 1));
  ASSERT_TRUE(until([&] { return size_of(part_file(run_, 2)) > 50'000; }));
  recorder.send(SIGINT);
  EXPECT_EQ(recorder.wait(kPatience), 0);
  EXPECT_THAT(recorder.errors(),
              AllOf(HasSubstr("run_000001.mcap: was deleted with"), HasSubstr("the recording continues in")));
  EXPECT_THAT(crane({"log", "info", run_.string()}).output, HasSubstr("samples in a file that was deleted"));
  EXPECT_THAT(recording::check(run_).problems, IsEmpty());
}

TEST_F(Record, IsReadableUpToTheLastSecondWhenItIsKilled) {
  ProgramRun recorder{kCrane, arguments({"--split-every", "2s"})};
  ASSERT_TRUE(until([&] { return size_of(part_file(run_, 2)) > 50'000; }));
  stack_.forget();
  stack_.listen(1500ms);
  const auto last_tick = stack_.observer().states().back().header.tick;
  recorder.send(SIGKILL);
  ASSERT_EQ(recorder.wait(kPatience), 128 + SIGKILL);
  const auto ticks = ticks_in(run_);
  EXPECT_EQ(missing_in(ticks), 0U);
  constexpr std::uint64_t kOneSecond = 100, kOfSlowWriting = 30;
  EXPECT_GE(ticks.back() + kOneSecond + kOfSlowWriting, last_tick);
}

TEST_F(Record, NamesADirectoryThatCannotBeWritten) {
  const auto refused =
      run_program(kCrane, {"record", "/proc/run.mcap", "--split-every", "1s", "--domain", "85"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("/proc/run_000001.mcap: cannot create: "));
}

}  // namespace
}  // namespace crane::system_test
