/// Data at their own times: jitter, gaps, several sample times.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "crane/diagnosis/diagnosis.hpp"
#include "crane/diagnosis/replay.hpp"
#include "data/grid.hpp"
#include "data/sensor.hpp"
#include "laboratory/strange_lab.hpp"
#include "shooting/problem.hpp"

namespace crane::diagnosis {
namespace {

using strange::Gantry;
using strange::Recording;
using testing::HasSubstr;

configuration::Rig gantry() { return configuration::load_rig(CRANE_RIGS "/gantry.toml"); }

Loaded loaded_as(const Recording& recording, double duration_s = 12, const Gantry& crane = {}) {
  return load_run(strange::recorded(strange::moved(crane, duration_s, strange::rich_command), recording),
                  gantry(), "lab.csv");
}

std::size_t seen_in(const Run& run, Output output) {
  std::size_t measured = 0;
  for (std::size_t row = 0; row < run.rows(); ++row) measured += run.is_measured(output, row) ? 1 : 0;
  return measured;
}

/// Every compared row has its own time and value.
void expect_rows_as_they_are(const recording::Table& table, const Run& run) {
  const auto &time_s = *table.find("time_s"), &position = *table.find("trolley_position_m");
  for (std::size_t row = 0; row < run.rows(); ++row) {
    if (!run.is_measured(kTrolleyPosition, row)) continue;
    const double at = run.start_s + run.instant_s(row);
    const auto found = std::min_element(time_s.begin(), time_s.end(), [&](double a, double b) {
      return std::abs(a - at) < std::abs(b - at);
    });
    ASSERT_NEAR(*found, at, 2e-6) << "row " << row;
    ASSERT_EQ(position[static_cast<std::size_t>(found - time_s.begin())],
              run.measured[kTrolleyPosition][row]);
  }
}

TEST(DataAtTheirOwnTimes, AMissingRowDoesNotCutTheRun) {
  const auto truth = strange::moved({}, 12, strange::rich_command);
  auto table = strange::recorded(truth, {});
  for (auto& column : table.columns) column.values.erase(column.values.begin() + 500);
  const Loaded loaded = load_run(table, gantry(), "lab.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  EXPECT_EQ(seen_in(loaded.runs[0], kTrolleyPosition), table.rows());
  EXPECT_FALSE(loaded.runs[0].is_measured(kTrolleyPosition, 500));
  expect_rows_as_they_are(table, loaded.runs[0]);
  EXPECT_THAT(loaded.notes.at(0), HasSubstr("1 rows are missing"));
}

TEST(DataAtTheirOwnTimes, JitterAndDroppedFramesLoseNoOtherRow) {
  for (const double row_s : {0.1, 0.0345, 0.01}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      SCOPED_TRACE("row " + std::to_string(row_s) + " s, seed " + std::to_string(seed));
      const Recording lab{.row_s = row_s, .jitter = 0.5, .dropped = 0.1, .seed = seed};
      const auto table = strange::recorded(strange::moved({}, 30, strange::rich_command), lab);
      const Loaded loaded = load_run(table, gantry(), "lab.csv");
      ASSERT_EQ(loaded.runs.size(), 1U);
      EXPECT_GE(static_cast<double>(seen_in(loaded.runs[0], kTrolleyPosition)),
                0.98 * static_cast<double>(table.rows()));
      expect_rows_as_they_are(table, loaded.runs[0]);
    }
  }
}

/// A grid whose period is too short by a thousandth is wrong by one row after ten seconds.
TEST(DataAtTheirOwnTimes, JitteredTimesDetermineTheirPeriod) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Recording lab{.row_s = 0.01, .jitter = 0.4, .seed = seed};
    const auto table = strange::recorded(strange::moved({}, 30, strange::rich_command), lab);
    const Loaded loaded = load_run(table, gantry(), "lab.csv");
    EXPECT_NEAR(loaded.runs.at(0).period_s, 0.01, 5e-6) << "seed " << seed;
    EXPECT_EQ(seen_in(loaded.runs[0], kTrolleyPosition), table.rows());
  }
}

TEST(DataAtTheirOwnTimes, TwoSampleTimesInOneFileAreOneRun) {
  const auto truth = strange::moved({}, 12, strange::rich_command);
  auto table = strange::recorded(truth, {.row_s = 0.0055});
  const auto slow = strange::recorded(truth, {.row_s = 0.0035});
  const auto before = [](const recording::Table& t) {
    return std::lower_bound(t.columns[0].values.begin(), t.columns[0].values.end(), 4.0) -
           t.columns[0].values.begin();
  };
  const auto kept = before(table), from = before(slow);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    table.columns[c].values.resize(static_cast<std::size_t>(kept));
    table.columns[c].values.insert(table.columns[c].values.end(), slow.columns[c].values.begin() + from,
                                   slow.columns[c].values.end());
  }
  const Loaded loaded = load_run(table, gantry(), "lab.csv");
  ASSERT_EQ(loaded.runs.size(), 1U);
  EXPECT_NEAR(loaded.runs[0].duration_s(), 12, 0.05);
  EXPECT_GE(seen_in(loaded.runs[0], kTrolleyPosition), 1200U) << "100 rows a second at least";
  expect_rows_as_they_are(table, loaded.runs[0]);
}

/// Without interpolation the error of the command would be its slope times one row, 0.1 V.
TEST(DataAtTheirOwnTimes, TheCommandOfADroppedRowIsInterpolated) {
  constexpr double kRow_s = 0.0275;
  const auto smooth = [](double t) { return 0.9 * std::cos(1.1 * t) + 0.7 * std::cos(2.9 * t + 1); };
  const auto whole = strange::recorded(strange::moved({}, 20, smooth), {.row_s = kRow_s});
  auto table = whole;
  for (auto& column : table.columns)
    for (std::size_t row = column.values.size() - 2; row > 2; --row)
      if (row % 7 == 3) column.values.erase(column.values.begin() + static_cast<std::ptrdiff_t>(row));
  const diagnosis::Run dropped = load_run(table, gantry(), "lab.csv").runs.at(0),
                       complete = load_run(whole, gantry(), "lab.csv").runs.at(0);
  ASSERT_EQ(dropped.rows(), complete.rows());
  EXPECT_TRUE(dropped.edge_lost[plant::kTrolley].empty());
  for (std::size_t row = 0; row < dropped.rows(); ++row)
    EXPECT_NEAR(dropped.command_v[row][plant::kTrolley], complete.command_v[row][plant::kTrolley], 0.003)
        << "row " << row;
}

TEST(DataAtTheirOwnTimes, AnEdgeOfTheCommandInADroppedRowIsMarked) {
  constexpr double kRow_s = 0.02;
  const auto edges = [](double t) { return std::fmod(t, 1.0) < 0.5 ? 0.8 : -0.8; };
  auto table = strange::recorded(strange::moved({}, 10, edges), {.row_s = kRow_s});
  constexpr std::size_t kAtAnEdge = 75, kElsewhere = 160;
  for (auto& column : table.columns)
    for (const std::size_t row : {kElsewhere, kAtAnEdge})
      column.values.erase(column.values.begin() + static_cast<std::ptrdiff_t>(row));
  const diagnosis::Run run = load_run(table, gantry(), "lab.csv").runs.at(0);
  for (std::size_t row = 0; row < run.rows(); ++row)
    EXPECT_EQ(run.may_have_lost_edge(kTrolleyPosition, row), row == kAtAnEdge || row == kAtAnEdge + 1)
        << "row " << row;
}

TEST(DataAtTheirOwnTimes, AreAcceptedFrom10HzOn) {
  EXPECT_EQ(loaded_as({.row_s = 0.1}).runs.size(), 1U);
  const diagnosis::Run fast = loaded_as({.row_s = 0.0005}).runs.at(0);
  EXPECT_NEAR(fast.period_s, 0.01, 1e-9);
  EXPECT_EQ(fast.commands.size(), 24000U) << "commands act at their own times";
  EXPECT_THROW((void)loaded_as({.row_s = 0.2}), DataError);
}

TEST(DataAtTheirOwnTimes, ASlowSensorIsComparedAtItsOwnRows) {
  const diagnosis::Run run = loaded_as({.row_s = 0.01, .swing_every_s = 0.0345}).runs.at(0);
  EXPECT_EQ(run.rows(), 1200U);
  EXPECT_EQ(seen_in(run, kTrolleyPosition), 1200U);
  EXPECT_NEAR(static_cast<double>(seen_in(run, kRadialSwing)), 12 / 0.0345, 3);
}

TEST(DataAtTheirOwnTimes, ASlowSensorInAFastFileLosesNoRow) {
  const diagnosis::Run run = loaded_as({.row_s = 0.001, .swing_every_s = 0.0345}).runs.at(0);
  EXPECT_NEAR(static_cast<double>(seen_in(run, kRadialSwing)), 12 / 0.0345, 3);
}

/// Largest error of the right model at the rows' own times.
double worst_prediction(const Recording& lab, Part part, Output output,
                        const std::function<double(double)>& command_v) {
  const auto rig = gantry();
  Recording exact = lab;
  exact.position_step_m = exact.swing_step_rad = 0;
  Run run =
      load_run(strange::recorded(strange::moved({}, 8, command_v, 0.3), exact), rig, "lab.csv").runs.at(0);
  const PreparedRun prepared = prepare(run, rig);
  const Replay replay(prepared, {rig.plant, rig.terms});
  const auto outputs = simulated_outputs(prepared, part);
  const std::size_t rows = run.rows();
  std::vector<double> start, out(rows * outputs.size());
  for (const Output o : outputs) start.insert(start.end(), {o == kTrolleyPosition ? 1.0 : 0.3, 0.0});
  replay.run(part, 0, rows, start, out);
  const auto at =
      static_cast<std::size_t>(std::find(outputs.begin(), outputs.end(), output) - outputs.begin());
  double worst = 0;
  for (std::size_t k = 0; k < rows; ++k)
    if (run.is_measured(output, k))
      worst = std::max(worst, std::abs(out[at * rows + k] - run.measured[output][k]));
  return worst;
}

double smooth_command(double t) { return 0.9 * std::cos(1.1 * t) + 0.7 * std::cos(2.9 * t + 1); }

/// One count of the swing encoder is 4e-4 rad, one count of the trolley encoder 2.5e-5 m.
TEST(DataPredictedAtOwnTimes, HaveErrorsBelowTheSensorsNoise) {
  const Recording jittered{.row_s = 0.01, .jitter = 0.6, .dropped = 0.1};
  EXPECT_LT(worst_prediction({.row_s = 0.01}, Part::load, kRadialSwing, smooth_command), 5e-5);
  EXPECT_LT(worst_prediction(jittered, Part::load, kRadialSwing, smooth_command), 5e-5);
  EXPECT_LT(worst_prediction({.row_s = 0.0345, .jitter = 0.6}, Part::load, kRadialSwing, smooth_command),
            3.5e-4);
}

/// Steps of the acceleration inside a gap are not in the measured motion.
TEST(DataPredictedAtOwnTimes, HaveBoundedErrorsOverGaps) {
  const Recording jittered{.row_s = 0.01, .jitter = 0.6, .dropped = 0.1};
  EXPECT_LT(worst_prediction(jittered, Part::load, kRadialSwing, strange::rich_command), 1e-3);
}

TEST(DataPredictedAtOwnTimes, FollowACommandThatChangesBetweenComparedRows) {
  // One row in ten is compared; the command changes every 2 ms.
  const auto held = [](double t) { return strange::rich_command(0.002 * std::floor(t / 0.002 + 1e-6)); };
  EXPECT_LT(worst_prediction({.row_s = 0.001}, Part::whole, kTrolleyPosition, held), 2e-4);
}

TEST(MissingData, HaveNoResidual) {
  const auto rig = gantry();
  const Runs runs{prepare(loaded_as({.row_s = 0.01, .jitter = 0.4, .dropped = 0.2}).runs.at(0), rig)};
  for (const Part part : {Part::drive, Part::load}) {
    const Problem plain(runs, part, 2, 2.5);
    const Replays replays = replays_of(runs, {rig.plant, rig.terms});
    for (const bool whitened : {false, true}) {
      const Problem problem = whitened ? plain.whitened_by(replays) : plain;
      const Fits fits = problem.fit(replays);
      for (std::size_t w = 0; w < fits.size(); ++w)
        for (std::size_t k = 0; k < problem.windows()[w].rows; ++k)
          if (!runs[0].run.is_measured(problem.outputs()[0], problem.windows()[w].first + k)) {
            const auto row = static_cast<Eigen::Index>(k);
            ASSERT_EQ(problem.measured(problem.windows()[w])[row] - fits[w].simulated[row], 0.0);
            if (whitened) {
              Eigen::MatrixXd one =
                  Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(problem.windows()[w].rows), 1);
              problem.whitener(0, w).apply(one);
              ASSERT_EQ(one(row, 0), 0.0);
            }
          }
    }
  }
}

TEST(DataOfASensor, GiveItsResolutionAndNoise) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> gauss;
  for (const double finer : {0.01, 1.0, 100.0}) {
    const double step = 1e-4 / finer;
    std::vector<double> counts, noisy;
    for (int k = 0; k < 4000; ++k) {
      const double x = 0.3 * std::sin(0.01 * k);
      counts.push_back(std::round(x / step) * step);
      noisy.push_back(x + 1e-3 * gauss(random));
    }
    EXPECT_NEAR(sensor_of(counts).resolution, step, 0.01 * step);
    EXPECT_NEAR(sensor_of(noisy).noise, 1e-3, 1e-4);
  }
}

TEST(DataOfASensor, OverrideTheResolutionOfTheRigFile) {
  const auto rig = gantry();
  for (const double finer : {0.01, 1.0, 100.0}) {
    const Recording lab{.row_s = 0.01, .position_step_m = 2.5e-5 / finer};
    const PreparedRun run = prepare(loaded_as(lab).runs.at(0), rig);
    EXPECT_NEAR(run.least_noise[kTrolleyPosition], std::max(1e-7, 2.5e-5 / finer / std::sqrt(12.0)), 1e-7);
  }
}

/// A gantry under a camera at 29 Hz with dropped frames and a mean of the angle over 0.37 s.
TEST(DataOfACamera, HaveNoLargerErrorsInWindowsThanOverWholeRuns) {
  const auto rig = gantry();
  const auto watched = [&](std::uint64_t seed) {
    const Recording lab{.row_s = 0.0345,
                        .jitter = 0.2,
                        .dropped = 0.05,
                        .swing_mean_s = 0.37,
                        .position_noise_m = 5e-4,
                        .swing_noise_rad = 1e-3,
                        .seed = seed};
    const auto command = [&](double t) {  // command of a loop that runs at the rate of the camera
      return strange::rich_command(0.0345 * std::floor(t / 0.0345 + 1e-6) + 5.0 * static_cast<double>(seed));
    };
    return load_run(strange::recorded(strange::moved({.drag_nspm = 3}, 20, command), lab), rig,
                    "camera_" + std::to_string(seed) + ".csv");
  };
  std::vector<diagnosis::Run> train, test;
  for (const std::uint64_t seed : {1U, 2U}) {
    ASSERT_EQ(watched(seed).runs.size(), 1U);
    train.push_back(watched(seed).runs[0]);
  }
  test.push_back(watched(3).runs.at(0));
  Request request;
  request.most_effects = 2;
  const Diagnosis found = diagnose(rig, train, test, request);
  const HeldOut& held_out = found.held_out;
  for (const char* column : {"swing_radial_rad", "trolley_position_m"}) {
    SCOPED_TRACE(column);
    EXPECT_LE(held_out.baseline_rms.at(column), 1.05 * held_out.whole_baseline_rms.at(column));
    EXPECT_LE(held_out.extended_rms.at(column), 1.05 * held_out.whole_extended_rms.at(column));
  }
  EXPECT_LT(held_out.extended_rms.at("swing_radial_rad"), 0.5 * held_out.baseline_rms.at("swing_radial_rad"))
      << found.sentence;
}

}  // namespace
}  // namespace crane::diagnosis
