#include <gtest/gtest.h>

#include <random>

#include "noise/learning.hpp"
#include "noise/whitening.hpp"

namespace crane::diagnosis {
namespace {

constexpr double kLeastNoise = 1e-7;

/// Residuals of a drive with viscous friction under a coloured acceleration, with sensor noise.
std::vector<Eigen::VectorXd> windows(double noise, double acceleration, double correlation_s,
                                     double damping_ps, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr double kPeriod_s = 0.01;
  const double keep = correlation_s > 0 ? std::exp(-kPeriod_s / correlation_s) : 0;
  std::vector<Eigen::VectorXd> all;
  for (int w = 0; w < 60; ++w) {
    Eigen::VectorXd measured(200);
    double a = acceleration * normal(random), v = 0.1 * normal(random), x = 0.1 * normal(random);
    for (Eigen::Index k = 0; k < measured.size(); ++k) {
      measured[k] = x + noise * normal(random);
      const double middle = v + 0.5 * kPeriod_s * (a - damping_ps * v);
      x += kPeriod_s * middle;
      v += kPeriod_s * (a - damping_ps * middle);
      a = keep * a + std::sqrt(1 - keep * keep) * acceleration * normal(random);
    }
    all.push_back(measured);
  }
  return all;
}

std::vector<WindowMotion> moving(const std::vector<Eigen::VectorXd>& residuals) {
  std::vector<WindowMotion> motions;
  for (const Eigen::VectorXd& r : residuals)
    motions.push_back({0.01, 0, MotionProfile(static_cast<std::size_t>(r.size()))});
  return motions;
}

TEST(Whitener, FindsNoiseAndDisturbanceOfADrive) {
  const auto residuals = windows(1e-4, 0.05, 0.5, 4, 11);
  const Disturbance learned = learn(residuals, moving(residuals), kLeastNoise);
  EXPECT_NEAR(learned.noise, 1e-4, 1e-5);
  EXPECT_NEAR(learned.acceleration, 0.05, 0.025);
  Disturbance truth;
  truth.noise = 1e-4, truth.acceleration = 0.05, truth.correlation_s = 0.5, truth.damping_ps = 4;
  const Disturbance near_the_truth = learn(residuals, moving(residuals), kLeastNoise, truth);
  EXPECT_LE(learned.misfit, near_the_truth.misfit + 2) << "windows of two seconds hardly tell half a second "
                                                          "from a whole one";
}

TEST(Whitener, LearnsTheQuantisationNoiseOfAnAxisAtRest) {
  const std::vector<Eigen::VectorXd> residuals(3, Eigen::VectorXd::Zero(200));
  const Disturbance learned = learn(residuals, moving(residuals), 1e-5);
  EXPECT_EQ(learned.noise, 1e-5);
  EXPECT_EQ(learned.acceleration, 0);
  EXPECT_EQ(learned.misfit, 0);
}

TEST(Whitener, MakesTheResidualWhite) {
  const auto residuals = windows(1e-4, 0.05, 0.5, 4, 12);
  const auto motions = moving(residuals);
  const Whitener whitener(learn(residuals, motions, kLeastNoise), motions[0]);
  double square = 0, neighbours = 0;
  for (Eigen::VectorXd r : residuals) {
    // The start of the window is projected out, as in the fit.
    Eigen::MatrixXd z(r.size(), 2);
    for (Eigen::Index k = 0; k < r.size(); ++k) z.row(k) << 1, 1 - std::exp(-0.04 * static_cast<double>(k));
    whitener.apply(r);
    whitener.apply(z);
    r -= z * z.colPivHouseholderQr().solve(r);
    square += r.squaredNorm() / static_cast<double>(r.size());
    neighbours += r.head(199).dot(r.tail(199)) / static_cast<double>(r.size());
  }
  const auto count = static_cast<double>(residuals.size());
  EXPECT_NEAR(square / count, 1, 0.1);
  EXPECT_NEAR(neighbours / count, 0, 0.1);
}

/// Residuals of an axis that moves, rests and breaks loose with a random impulse.
struct Sticking {
  std::vector<Eigen::VectorXd> residuals;
  std::vector<WindowMotion> motions;
};
Sticking sticking(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr double kPeriod_s = 0.01, kNoise = 1e-6, kForce = 0.05, kImpulse = 3e-3;
  Sticking all;
  for (int w = 0; w < 40; ++w) {
    Eigen::VectorXd measured(200);
    WindowMotion motion{kPeriod_s, 0, MotionProfile(200)};
    double x = 0, v = 0, a = 0;
    for (std::size_t k = 0; k < 200; ++k) {
      const std::size_t phase = (k + 13 * static_cast<std::size_t>(w)) % 80;
      RowMotion& row_motion = motion.profile[k];
      if (phase < 30) row_motion = {1, MotionPhase::standing};
      if (phase >= 30 && phase < 33) row_motion = {1, MotionPhase::turning};
      measured[static_cast<Eigen::Index>(k)] = x + kNoise * normal(random);
      if (row_motion.phase != MotionPhase::moving) v = 0;
      if (row_motion.phase == MotionPhase::turning) v = kImpulse * normal(random);
      a = 0.95 * a + 0.31 * kForce * normal(random);
      if (row_motion.phase != MotionPhase::standing) x += kPeriod_s * v, v += kPeriod_s * a;
    }
    all.residuals.push_back(measured);
    all.motions.push_back(motion);
  }
  return all;
}

TEST(Whitener, FiltersEveryColumnAsIfItWereAlone) {
  const std::vector<Eigen::VectorXd> residuals = windows(1e-4, 0.05, 0.5, 4, 11);
  const Whitener whitener(learn(residuals, moving(residuals), kLeastNoise), moving(residuals)[0]);
  Eigen::MatrixXd together(residuals[0].size(), 7);
  for (Eigen::Index i = 0; i < together.cols(); ++i) together.col(i) = residuals[static_cast<std::size_t>(i)];
  whitener.apply(together);
  for (Eigen::Index i = 0; i < together.cols(); ++i) {
    Eigen::MatrixXd alone = residuals[static_cast<std::size_t>(i)];
    whitener.apply(alone);
    EXPECT_EQ(together.col(i), alone) << "column " << i;
  }
}

TEST(Whitener, FindsThatAnAxisSticks) {
  const Sticking data = sticking(3);
  const Disturbance learned = learn(data.residuals, data.motions, kLeastNoise);
  EXPECT_TRUE(learned.sticks);
  EXPECT_GT(learned.friction, 0);
  EXPECT_NEAR(learned.noise, 1e-6, 3e-7);
  EXPECT_GT(learned.acceleration, 0.02);
  EXPECT_LT(learned.acceleration, 0.12);
}

/// A command that changes once in a window acts at an inaccurate time: from then on, the speed is wrong.
TEST(Whitener, DistinguishesTheErrorOfAnInaccurateTime) {
  constexpr double kSpeedError = 2e-3, kNoise = 1e-5;
  constexpr std::size_t kEdge = 90;
  auto residuals = windows(kNoise, 0, 0, 0, 6);
  auto accurate = moving(residuals), inaccurate = accurate;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (std::size_t w = 0; w < residuals.size(); ++w) {
    const double error = kSpeedError * normal(random);
    for (Eigen::Index k = kEdge; k < residuals[w].size(); ++k)
      residuals[w][k] += error * 0.01 * static_cast<double>(k - static_cast<Eigen::Index>(kEdge));
    inaccurate[w].profile[kEdge].speed_inaccuracy = kSpeedError;
  }
  const Disturbance known = learn(residuals, inaccurate, kLeastNoise);
  EXPECT_NEAR(known.noise, kNoise, 0.1 * kNoise);
  EXPECT_LT(known.acceleration, 1e-3);
  const Disturbance unknown = learn(residuals, accurate, kLeastNoise);
  EXPECT_GT(unknown.acceleration, 10 * known.acceleration) << "it passes for a disturbance";
  EXPECT_LT(known.misfit, unknown.misfit);
}

TEST(Whitener, FindsThatASlowAxisDoesNotStick) {
  auto residuals = windows(1e-4, 0.05, 0.5, 4, 5);
  auto motions = moving(residuals);
  for (WindowMotion& motion : motions)
    for (std::size_t k = 80; k < 120; ++k) motion.profile[k] = {1, MotionPhase::standing};
  EXPECT_FALSE(learn(residuals, motions, kLeastNoise).sticks);
}

/// Refits learn the noise again from nearly the same residuals.
TEST(Whitener, LearnsNoLessLikelyNoiseWhenItLearnsAgain) {
  const Sticking data = sticking(3);
  auto inaccurate = data.motions;
  for (WindowMotion& motion : inaccurate)
    for (std::size_t k = 0; k < motion.profile.size(); k += 20) motion.profile[k].speed_inaccuracy = 1e-3;
  for (const double least : {kLeastNoise, 3e-6})  // the noise is 1e-6
    for (const auto& motions : {data.motions, inaccurate}) {
      Disturbance before = learn(data.residuals, motions, least);
      for (int round = 0; round < 5; ++round) {
        const Disturbance again = learn(data.residuals, motions, least, before);
        EXPECT_LE(again.misfit, before.misfit + 1e-6) << "least noise " << least << ", round " << round;
        before = again;
      }
    }
}

}  // namespace
}  // namespace crane::diagnosis
