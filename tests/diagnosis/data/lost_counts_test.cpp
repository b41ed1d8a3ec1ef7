#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "data/lost_counts.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kSample_s = 0.01;
constexpr int kRows = 3000;

configuration::Rig rig_of_losses() {
  return configuration::load_rig(std::string{CRANE_RIGS} + "/virginia_tech_tower.toml");
}

/// Motion of the slew in whole counts.
Run counted(const std::function<double(double)>& angle_rad) {
  const double counts_per_rad = rig_of_losses().encoders[kSlewAngle].counts_per_unit;
  Run run;
  run.period_s = kSample_s;
  run.command_v.resize(kRows);
  for (int k = 0; k < kRows; ++k)
    run.measured[kSlewAngle].push_back(std::round(angle_rad(kSample_s * k) * counts_per_rad) /
                                       counts_per_rad);
  return run;
}

double swinging_rad(double t) { return 0.8 * std::sin(1.1 * t) + 0.05 * std::sin(7 * t); }

/// About two jumps of 2 to 6 mrad per second; one jump is in the first row, two jumps are in neighbouring
/// rows.
Run losing(std::uint64_t seed, double& lost_rad) {
  Run run = counted(swinging_rad);
  std::mt19937_64 random(seed);
  std::vector<std::size_t> rows{1, 700, 701};
  while (rows.size() < 60) rows.push_back(random() % kRows);
  lost_rad = 0;
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  for (const std::size_t row : rows) {
    const double jump_rad = 0.002 + 0.004 * static_cast<double>(random() % 1000) / 1000;
    lost_rad += jump_rad;
    for (std::size_t k = row; k < kRows; ++k) run.measured[kSlewAngle][k] += jump_rad;
  }
  return run;
}

TEST(LostCounts, AreFoundAndRemovedToAFewCounts) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    double lost_rad = 0;
    const auto run = losing(seed, lost_rad);
    const auto found = losing_encoders({run}, rig_of_losses());
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].axis, kSlewAngle);
    EXPECT_NEAR(found[0].lost, lost_rad, 0.01 * lost_rad);
    EXPECT_NEAR(found[0].jump, 0.004, 0.001);
    const auto mended = without_count_losses({run}, found, rig_of_losses())[0], whole = counted(swinging_rad);
    const double start = mended.measured[kSlewAngle][0] - whole.measured[kSlewAngle][0];
    double worst = 0;
    for (std::size_t k = 0; k + 1 < kRows; ++k) {
      const auto step = [k](const auto& r) {
        return r.measured[kSlewAngle][k + 1] - r.measured[kSlewAngle][k];
      };
      worst = std::max(worst, std::abs(step(mended) - step(whole)));
    }
    EXPECT_LT(worst, 4e-4);
    EXPECT_LT(std::abs(start), 1e-12);
  }
}

/// A fine sensor at 1 kHz shows the roughness of the motion, a coarse one its counts.
TEST(LostCounts, AreNotFoundAtAnyResolution) {
  for (const double finer : {1.0, 100.0, 0.01}) {
    auto rig = rig_of_losses();
    rig.encoders[kTrolleyPosition].counts_per_unit *= finer;
    const double counts_per_m = rig.encoders[kTrolleyPosition].counts_per_unit;
    for (const unsigned seed : {1U, 2U, 3U}) {
      std::mt19937_64 random(seed);
      std::normal_distribution<double> gauss(0, 1e-6);
      std::exponential_distribution<double> tail(1e6);
      diagnosis::Run run;
      run.period_s = 0.001;
      for (int k = 0; k < 12000; ++k) {
        const double t = run.period_s * k;
        const double noise = gauss(random) + (random() % 2 == 0 ? 1 : -1) * tail(random);
        const double position = 0.5 + 0.2 * std::sin(2 * t) + 0.005 * std::sin(23 * t) + noise;
        run.measured[kTrolleyPosition].push_back(std::round(position * counts_per_m) / counts_per_m);
        run.command_v.emplace_back();
      }
      EXPECT_TRUE(losing_encoders({run}, rig).empty()) << "counts " << finer << " times finer, seed " << seed;
    }
  }
}

TEST(LostCounts, AreNotFoundInAnUndisturbedMotion) {
  EXPECT_TRUE(losing_encoders({counted(swinging_rad)}, rig_of_losses()).empty());
}

/// An impact in a gap changes the motor's speed at once.
TEST(LostCounts, AreNotFoundWhereTheSpeedJumps) {
  const auto knocked = [](double t) { return 0.2 * std::abs(std::sin(3 * t)); };
  EXPECT_TRUE(losing_encoders({counted(knocked)}, rig_of_losses()).empty());
}

TEST(LostCounts, AreNotFoundWhereAnAxisSticksAndBreaksLoose) {
  const auto sticking = [](double t) {
    const double phase = std::fmod(t, 0.5);
    return 0.02 * std::floor(t / 0.5) + (phase < 0.4 ? 0 : 2 * (phase - 0.4) * (phase - 0.4));
  };
  EXPECT_TRUE(losing_encoders({counted(sticking)}, rig_of_losses()).empty());
}

/// Between two rows a drive can break loose and come to rest, if its command is large enough.
TEST(LostCounts, AreNotFoundWhereTheDriveCanSlipAsFar) {
  const auto slipping = [](double t) { return 0.002 * std::floor(t / 0.25); };
  auto run = counted(slipping);
  ASSERT_EQ(losing_encoders({run}, rig_of_losses()).size(), 1U);
  const double gain = rig_of_losses().plant.slew_gain_radps2pv;
  for (plant::PerAxis& volts : run.command_v)
    volts[plant::kSlew] = 1.1 * 2 * 0.002 / (gain * kSample_s * kSample_s);
  EXPECT_TRUE(losing_encoders({run}, rig_of_losses()).empty());
}

TEST(LostCounts, AreNotFoundInTwoJumps) {
  auto run = counted(swinging_rad);
  for (const std::size_t row : {500U, 1500U})
    for (std::size_t k = row; k < kRows; ++k) run.measured[kSlewAngle][k] += 0.004;
  EXPECT_TRUE(losing_encoders({run}, rig_of_losses()).empty());
}

}  // namespace
}  // namespace crane::diagnosis
