#include <Eigen/Dense>
#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>
#include <cmath>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

Motion savitzky_golay(std::span<const double> measured, double period_s, int half_width) {
  const auto rows = static_cast<int>(measured.size());
  const int width = std::min(2 * half_width + 1, rows);
  constexpr int kOrder = 3;
  Motion motion;
  for (auto* values : {&motion.position, &motion.rate, &motion.acceleration}) values->resize(measured.size());
  // Coefficients of the cubic are linear in the samples, one set per place in the window.
  const int order = std::min(kOrder, width - 1);
  std::vector<Eigen::MatrixXd> weights(static_cast<std::size_t>(width));
  for (int centre = 0; centre < width; ++centre) {
    Eigen::MatrixXd powers(width, order + 1);
    for (int i = 0; i < width; ++i)
      for (int j = 0; j <= order; ++j) powers(i, j) = std::pow((i - centre) * period_s, j);
    weights[static_cast<std::size_t>(centre)] =
        powers.colPivHouseholderQr().solve(Eigen::MatrixXd::Identity(width, width));
  }
  for (int k = 0; k < rows; ++k) {
    const int first = std::clamp(k - half_width, 0, rows - width);
    const Eigen::MatrixXd& w = weights[static_cast<std::size_t>(k - first)];
    const Eigen::Map<const Eigen::VectorXd> samples(&measured[static_cast<std::size_t>(first)], width);
    const auto at = static_cast<std::size_t>(k);
    motion.position[at] = w.row(0).dot(samples);
    motion.rate[at] = order >= 1 ? w.row(1).dot(samples) : 0;
    motion.acceleration[at] = order >= 2 ? 2 * w.row(2).dot(samples) : 0;
  }
  return motion;
}

namespace {

/// Second derivatives of the cubic spline at its knots, with "not a knot" ends: a tridiagonal system (C. de
/// Boor, A Practical Guide to Splines, 1978, ch. IV).
std::vector<double> second_derivatives(std::span<const double> t, std::span<const double> x) {
  const std::size_t n = t.size();
  std::vector<double> curvature(n, 0.0), upper(n, 0.0);
  if (n < 4) return curvature;
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double before = t[k] - t[k - 1], after = t[k + 1] - t[k];
    double below = before, diagonal = 2 * (before + after), above = after;
    if (k == 1) diagonal += before * (1 + before / after), above -= before * before / after, below = 0;
    if (k + 2 == n) diagonal += after * (1 + after / before), below -= after * after / before, above = 0;
    const double pivot = diagonal - below * upper[k - 1];
    const double turn = 6 * ((x[k + 1] - x[k]) / after - (x[k] - x[k - 1]) / before);
    upper[k] = above / pivot;
    curvature[k] = (turn - below * curvature[k - 1]) / pivot;
  }
  for (std::size_t k = n - 2; k-- > 1;) curvature[k] -= upper[k] * curvature[k + 1];
  const auto extrapolate = [&](std::size_t end, std::size_t near, std::size_t far) {
    curvature[end] =
        curvature[near] + (curvature[near] - curvature[far]) * (t[end] - t[near]) / (t[near] - t[far]);
  };
  extrapolate(0, 1, 2);
  extrapolate(n - 1, n - 2, n - 3);
  return curvature;
}

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// State position, speed, acceleration, in multiples of the sensor noise; white jerk.
struct WhiteJerk {
  double variance_ps5 = 0;  ///< of the jerk, over that of the sensor

  [[nodiscard]] static Matrix3d step(double h) {
    Matrix3d f;
    f << 1, h, 0.5 * h * h, 0, 1, h, 0, 0, 1;
    return f;
  }
  [[nodiscard]] Matrix3d added(double h) const {
    const double h2 = h * h, h3 = h2 * h, h4 = h3 * h, h5 = h4 * h;
    Matrix3d q;
    q << h5 / 20, h4 / 8, h3 / 6, h4 / 8, h3 / 3, h2 / 2, h3 / 6, h2 / 2, h;
    return variance_ps5 * q;
  }
};

/// Filter states and covariances before and after each sample.
struct Filtered {
  std::vector<Vector3d> before, after;
  std::vector<Matrix3d> covariance_before, covariance_after;
  double squares = 0, logs = 0;  ///< innovations over their variances, ln variances
  double count = 0;
  /// Minus twice the log likelihood for the sensor's standard deviation `noise`.
  [[nodiscard]] double misfit(double noise) const {
    return logs + 2 * count * std::log(noise) + squares / (noise * noise);
  }
};

Filtered filtered(std::span<const double> t, std::span<const double> x, const WhiteJerk& jerk) {
  constexpr double kUnknownStart = 1e8;  // variance of the start, over that of the sensor
  const std::size_t n = t.size();
  const double h0 = (t[n - 1] - t[0]) / static_cast<double>(n - 1);
  Filtered f;
  Vector3d state{x[0], 0, 0};
  Matrix3d covariance =
      Vector3d{kUnknownStart, kUnknownStart / (h0 * h0), kUnknownStart / std::pow(h0, 4)}.asDiagonal();
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) {
      const Matrix3d step = WhiteJerk::step(t[k] - t[k - 1]);
      state = step * state;
      covariance = step * covariance * step.transpose() + jerk.added(t[k] - t[k - 1]);
    }
    f.before.push_back(state);
    f.covariance_before.push_back(covariance);
    const double innovation = x[k] - state[0], variance = covariance(0, 0) + 1;
    if (k >= 3) f.squares += innovation * innovation / variance, f.logs += std::log(variance), ++f.count;
    const Vector3d gain = covariance.col(0) / variance;
    state += gain * innovation;
    covariance -= gain * covariance.row(0);
    f.after.push_back(state);
    f.covariance_after.push_back(covariance);
  }
  return f;
}

}  // namespace

std::vector<double> rts_smoothed(std::span<const double> time_s, std::span<const double> measured,
                                 double least_noise) {
  constexpr std::size_t kFewest = 8;
  const std::size_t n = time_s.size();
  if (n < kFewest || !(least_noise > 0)) return {measured.begin(), measured.end()};
  const double h = (time_s[n - 1] - time_s[0]) / static_cast<double>(n - 1);
  Filtered likeliest;
  double least_misfit = 0;
  for (int half_decade = -8; half_decade <= 16; ++half_decade) {
    // The jerk moves the axis by about 10^(half_decade / 4) noises per sample.
    Filtered tried = filtered(time_s, measured, {std::pow(10, 0.5 * half_decade) / std::pow(h, 5)});
    const double misfit = tried.misfit(std::max(least_noise, std::sqrt(tried.squares / tried.count)));
    if (!likeliest.after.empty() && misfit >= least_misfit) continue;
    likeliest = std::move(tried);
    least_misfit = misfit;
  }
  std::vector<double> smoothed(n);
  Vector3d state = likeliest.after[n - 1];
  smoothed[n - 1] = state[0];
  for (std::size_t k = n - 1; k-- > 0;) {
    const Matrix3d back = likeliest.covariance_after[k] *
                          WhiteJerk::step(time_s[k + 1] - time_s[k]).transpose() *
                          likeliest.covariance_before[k + 1].inverse();
    state = likeliest.after[k] + back * (state - likeliest.before[k + 1]);
    smoothed[k] = state[0];
  }
  return smoothed;
}

Motion spline_of(std::span<const double> time_s, std::span<const double> measured, double period_s,
                 std::size_t rows) {
  const std::size_t n = time_s.size();
  Motion motion;
  for (auto* values : {&motion.position, &motion.rate, &motion.acceleration}) values->assign(rows, 0.0);
  if (n == 0) return motion;
  const std::vector<double> curvature = second_derivatives(time_s, measured);
  for (std::size_t row = 0, k = 0; row < rows; ++row) {
    const double at = static_cast<double>(row) * period_s;
    while (k + 2 < n && time_s[k + 1] <= at) ++k;
    if (n == 1 || at < time_s[0] - period_s || at > time_s[n - 1] + period_s) {
      motion.position[row] = at < time_s[0] ? measured[0] : measured[n - 1];
      continue;
    }
    const double h = time_s[k + 1] - time_s[k], b = (at - time_s[k]) / h, a = 1 - b;
    motion.position[row] = a * measured[k] + b * measured[k + 1] +
                           h * h / 6 * ((a * a * a - a) * curvature[k] + (b * b * b - b) * curvature[k + 1]);
    motion.rate[row] = (measured[k + 1] - measured[k]) / h +
                       h / 6 * ((3 * b * b - 1) * curvature[k + 1] - (3 * a * a - 1) * curvature[k]);
    motion.acceleration[row] = a * curvature[k] + b * curvature[k + 1];
  }
  return motion;
}

Motion spline(std::span<const double> measured, double period_s) {
  constexpr std::size_t kFewest = 8;
  if (measured.size() < kFewest) return savitzky_golay(measured, period_s, 1);
  const boost::math::interpolators::cardinal_cubic_b_spline<double> through(measured.begin(), measured.end(),
                                                                            0, period_s);
  Motion motion{{measured.begin(), measured.end()}, {}, {}};
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double time_s = static_cast<double>(k) * period_s;
    motion.rate.push_back(through.prime(time_s));
    motion.acceleration.push_back(through.double_prime(time_s));
  }
  return motion;
}

}  // namespace crane::diagnosis
