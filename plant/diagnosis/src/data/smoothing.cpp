#include <Eigen/Dense>
#include <boost/math/interpolators/cardinal_cubic_b_spline.hpp>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

Motion smooth(std::span<const double> measured, double period_s, int half_width) {
  const auto rows = static_cast<int>(measured.size());
  const int width = std::min(2 * half_width + 1, rows);
  constexpr int kOrder = 3;
  Motion motion;
  for (auto* values : {&motion.position, &motion.rate, &motion.acceleration}) values->resize(measured.size());
  // The cubic's coefficients are fixed linear combinations of the samples, one set per place in the window.
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

Motion spline(std::span<const double> measured, double period_s) {
  constexpr std::size_t kFewest = 8;
  if (measured.size() < kFewest) return smooth(measured, period_s, 1);
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
