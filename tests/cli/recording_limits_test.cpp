// Options that split a recording: values, defaults, and every problem at once.
#include "cli/recording_limits.hpp"

#include <gmock/gmock.h>

#include "cli/recording_argument.hpp"
#include "crane/configuration/rig.hpp"
#include "temporary_directory.hpp"

namespace crane::cli {
namespace {

using recording::put_contents;
using testing::AllOf;
using testing::HasSubstr;

std::string problems_of(const LimitOptions& options) {
  try {
    (void)limits_of(options);
  } catch (const configuration::ConfigurationError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RecordingLimits, AreThoseOfTheOptions) {
  EXPECT_FALSE(limits_of({}).split());
  const auto limits = limits_of({.split_size = "50MB", .split_every = "10min", .quota = "1GB"});
  EXPECT_EQ(limits.part_bytes, 50'000'000U);
  EXPECT_EQ(limits.part, std::chrono::minutes{10});
  EXPECT_EQ(limits.quota_bytes, 1'000'000'000U);
}

TEST(RecordingLimits, SplitAQuotaIntoTenPartsOfAtLeastTheSmallestSize) {
  EXPECT_EQ(limits_of({.split_size = "", .split_every = "", .quota = "1GB"}).part_bytes, 100'000'000U);
  EXPECT_EQ(limits_of({.split_size = "", .split_every = "1h", .quota = "3MB"}).part_bytes,
            recorder::kSmallestPart_bytes);
}

TEST(RecordingLimits, RefuseWhatCannotBeRecordedAndNameEveryProblem) {
  EXPECT_THAT(problems_of({.split_size = "0", .split_every = "0", .quota = "0"}),
              AllOf(HasSubstr("--split-size: '0' is not between 1 byte"),
                    HasSubstr("--split-every: '0' is not a positive time"),
                    HasSubstr("--quota: '0' is not between 1 byte")));
  EXPECT_THAT(problems_of({.split_size = "999kB", .split_every = "0.5s", .quota = ""}),
              AllOf(HasSubstr("'999kB' is less than 1MB"), HasSubstr("'0.5s' is less than 1s")));
  EXPECT_THAT(problems_of({.split_size = "10MB", .split_every = "", .quota = "5MB"}),
              HasSubstr("--quota: '5MB' has no room for two parts of 10000000 bytes"));
  EXPECT_THAT(problems_of({.split_size = "", .split_every = "", .quota = "1.9MB"}),
              HasSubstr("no room for two parts"));
  EXPECT_EQ(problems_of({.split_size = "10MB", .split_every = "", .quota = "20MB"}), "accepted");
}

TEST(RecordingArgument, IsAFileOrTheNameOfParts) {
  const recording::TemporaryDirectory directory;
  auto run = (directory / "run.mcap").string();
  const auto problem = [&] { return existing_recording()(run); };
  EXPECT_THAT(problem(), HasSubstr("no such file, and no parts " + (directory / "run_000001.mcap").string()));
  put_contents(directory / "run_000003.mcap", "x");
  EXPECT_EQ(problem(), "");
  EXPECT_EQ(existing_files_of(run).size(), 1U);
  put_contents(run, "x");
  EXPECT_EQ(problem(), "");
  EXPECT_EQ(existing_files_of(run).size(), 2U);
}

}  // namespace
}  // namespace crane::cli
