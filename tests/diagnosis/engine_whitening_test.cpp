#include <gtest/gtest.h>

#include <random>

#include "whitening.hpp"

namespace crane::diagnosis {
namespace {

/// Windows of a drive with viscous friction under a coloured acceleration, seen with noise.
std::vector<Eigen::VectorXd> windows(double noise, double acceleration, double correlation_s,
                                     double damping_ps, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr double kPeriod_s = 0.01;
  const double keep = correlation_s > 0 ? std::exp(-kPeriod_s / correlation_s) : 0;
  std::vector<Eigen::VectorXd> all;
  for (int w = 0; w < 60; ++w) {
    Eigen::VectorXd seen(200);
    double a = acceleration * normal(random), v = 0.1 * normal(random), x = 0.1 * normal(random);
    for (Eigen::Index k = 0; k < seen.size(); ++k) {
      seen[k] = x + noise * normal(random);
      const double middle = v + 0.5 * kPeriod_s * (a - damping_ps * v);
      x += kPeriod_s * middle;
      v += kPeriod_s * (a - damping_ps * middle);
      a = keep * a + std::sqrt(1 - keep * keep) * acceleration * normal(random);
    }
    all.push_back(seen);
  }
  return all;
}

TEST(Whitener, FindsNoiseAndDisturbanceOfADrive) {
  const Whitener whitener(windows(1e-4, 0.05, 0.5, 4, 11), 0.01, 0);
  EXPECT_NEAR(whitener.disturbance().noise, 1e-4, 1e-5);
  EXPECT_NEAR(whitener.disturbance().correlation_s, 0.5, 0.31);  // the grid's neighbours are 0.2 and 1
  EXPECT_NEAR(whitener.disturbance().acceleration, 0.05, 0.025);
}

TEST(Whitener, MakesTheResidualWhite) {
  const auto residuals = windows(1e-4, 0.05, 0.5, 4, 12);
  const Whitener whitener(residuals, 0.01, 0);
  double square = 0, neighbours = 0;
  for (Eigen::VectorXd r : residuals) {
    // The free start of a window is taken out first, as the fit does.
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

}  // namespace
}  // namespace crane::diagnosis
