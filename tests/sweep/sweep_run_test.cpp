#include "sweep/sweep_run.hpp"

#include <gmock/gmock.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <iterator>

#include "../recording/temporary_directory.hpp"
#include "stack/data_files.hpp"

namespace crane::sweep {
namespace {

using testing::HasSubstr;

constexpr const char* kSmall = R"(
description = "Two controllers, three loads."
scenarios = ["maneuver_1"]
controllers = ["gain_scheduling_partial", "delayed_1"]
integrator = "fast"
seeds = 3
[[draw]]
key = "plant.load_mass_kg"
low = 1.0
high = 3.0
)";

Sweep small(const std::string& more = "") {
  return parse_sweep(kSmall + more, "small.toml", {stack::find_rig, stack::find_scenario});
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

class SweepRun : public testing::Test {
 protected:
  void SetUp() override { spdlog::set_level(spdlog::level::off); }
  recording::TemporaryDirectory directory_;
};

TEST_F(SweepRun, GivesTheSameBytesForAnyNumberOfProcessesAndAfterInterruptions) {
  const auto sweep = small();
  const auto one = directory_ / "one", three = directory_ / "three", parts = directory_ / "parts";
  EXPECT_EQ(run_sweep(sweep, {.directory = one, .processes = 1}).size(), 2U);
  EXPECT_EQ(run_sweep(sweep, {.directory = three, .processes = 3}).size(), 2U);
  std::size_t interruptions = 0;
  for (bool done = false; !done; ++interruptions) {
    std::size_t news = 0;
    done = !run_sweep(sweep, {.directory = parts,
                              .processes = 2,
                              .progress = [&](const Progress& progress) { news = progress.new_runs; },
                              .cancelled = [&] { return news >= 2; }})
                .empty();
    if (!done) {
      EXPECT_FALSE(std::filesystem::exists(parts / "runs.csv"));
      std::ofstream{parts / "sweep.jsonl", std::ios::app} << "{\"run\": 1, \"stop";  // killed while writing
    }
  }
  EXPECT_GE(interruptions, 3U);
  for (const char* file : {"runs.csv", "sweep.html"}) {
    EXPECT_GT(content_of(one / file).size(), 100U);
    EXPECT_EQ(content_of(one / file), content_of(three / file));
    EXPECT_EQ(content_of(one / file), content_of(parts / file));
  }
}

TEST_F(SweepRun, WritesARowPerRunWithDrawnValuesAndFigures) {
  const auto sweep = small();
  (void)run_sweep(sweep, {.directory = directory_ / "out", .processes = 2});
  std::istringstream csv{content_of(directory_ / "out" / "runs.csv")};
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_THAT(lines[0], testing::StartsWith("run,scenario,rig,variant,controller,seed,plant.load_mass_kg,"
                                            "stopped_because,settling_time_s,"));
  for (std::size_t i = 0; i < sweep.size(); ++i) {
    const sweep::Run run = run_of(sweep, i);
    EXPECT_THAT(lines[i + 1], testing::StartsWith(std::to_string(i) + ",maneuver_1,virginia_tech_tower,," +
                                                  run.controller + ',' + std::to_string(run.seed) + ',' +
                                                  recording::shortest(run.drawn[0]) + ",,"));
  }
}

/// One run of the sweep, alone: the settling time of `crane run`.
TEST_F(SweepRun, HasTheResultsOfSingleRuns) {
  const auto sweep = small();
  const auto groups = run_sweep(sweep, {.directory = directory_ / "out", .processes = 2});
  const auto alone = simulate(sweep, run_of(sweep, 4));
  ASSERT_TRUE(alone.metrics && alone.metrics->settling_time_s);
  EXPECT_THAT(groups[1].settling_s, testing::Contains(*alone.metrics->settling_time_s));
  EXPECT_EQ(groups[1].controller, "delayed_1");
  EXPECT_EQ(groups[1].runs, 3U);
}

TEST_F(SweepRun, DoesNotMixTheResultsOfTwoSweeps) {
  (void)Log{directory_ / "sweep.jsonl", small()};
  try {
    (void)Log{directory_ / "sweep.jsonl",
              small("[[draw]]\nkey = \"start.swing_radial_rad\"\nlow = 0\nhigh = 0.1")};
    FAIL() << "accepted";
  } catch (const LogError& error) {
    EXPECT_THAT(error.what(), HasSubstr("sweep.jsonl: has results of another sweep"));
  }
}

TEST_F(SweepRun, RefusesADamagedLog) {
  for (const char* line : {"{\"run\": 77, \"stopped_because\": \"\"}", "{\"run\": \"x\"}",
                           "{\"run\": -1, \"stopped_because\": \"\"}", "{\"run\": 0}",
                           "{\"run\": 0, \"stopped_because\": 3}", "[0]", "run 0"}) {
    SCOPED_TRACE(line);
    const auto file = directory_ / "sweep.jsonl";
    std::filesystem::remove(file);
    { const Log begun{file, small()}; }
    std::ofstream{file, std::ios::app} << line << '\n';
    try {
      (void)Log{file, small()};
      FAIL() << "accepted";
    } catch (const LogError& error) {
      EXPECT_THAT(error.what(), HasSubstr("sweep.jsonl:2: damaged: \""));
    }
  }
}

TEST_F(SweepRun, AnImpossibleRunIsARowWithItsReason) {
  const auto sweep = small();
  std::map<std::size_t, Result> results;
  for (std::size_t i = 0; i < sweep.size(); ++i) results[i] = failed(run_of(sweep, i), "signal 11");
  EXPECT_THAT(csv_of(sweep, results), HasSubstr(",the process of the run ended with signal 11,,"));
  const auto groups = groups_of(sweep, results);
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[0].stopped, 3U);
  EXPECT_THAT(summary_of(groups), HasSubstr("0.0 %"));
  EXPECT_THAT(report::to_html(page_of(sweep, groups)), HasSubstr("signal 11"));
}

TEST(SweepProgress, StatesRateAndRemainingTime) {
  EXPECT_EQ(to_string(Progress{.done = 0, .all = 100}), "0 of 100 runs");
  EXPECT_EQ(to_string(Progress{.done = 60, .all = 100, .new_runs = 10, .elapsed_s = 5}),
            "60 of 100 runs, 2.0 runs/s, 0:20 left");
  EXPECT_EQ(to_string(Progress{.done = 1, .all = 10001, .new_runs = 1, .elapsed_s = 1}),
            "1 of 10001 runs, 1.0 runs/s, 2 h 46 min left");
}

TEST(SweepQuantile, InterpolatesBetweenSortedValues) {
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_EQ(quantile({3}, 0.9), 3);
  EXPECT_EQ(quantile({1, 2, 4}, 0.5), 2);
  EXPECT_EQ(quantile({1, 2, 4}, 0.75), 3);
  EXPECT_EQ(quantile({1, 2, 4}, 1), 4);
}

}  // namespace
}  // namespace crane::sweep
