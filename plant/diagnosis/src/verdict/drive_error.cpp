#include "verdict/drive_error.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <numeric>
#include <sstream>

#include "rules.hpp"
#include "study/inaccuracies.hpp"

namespace crane::diagnosis {
namespace {

double squared(double x) { return x * x; }

/// Mean square over the measured rows of an output in a window, of values of all outputs.
double mean_square(const Problem& problem, std::size_t window, std::size_t output,
                   const Eigen::VectorXd& values) {
  const Window& w = problem.windows()[window];
  const auto rows = static_cast<Eigen::Index>(w.rows);
  return values.segment(static_cast<Eigen::Index>(output) * rows, rows).squaredNorm() /
         static_cast<double>(problem.measured_rows(w, output));
}

/// A crane whose rig file is wrong by one stated inaccuracy, with the variance of the error over the square
/// of the inaccuracy.
struct Inaccurate {
  Crane crane;
  double variance = 0;
};

/// An error of a quantity is uniform between its bounds. Level and asymmetry of a friction are half the sum
/// and half the difference of the frictions of the two directions, whose errors are independent.
std::vector<Inaccurate> inaccurate_cranes(const Study& study, const Crane& crane,
                                          const configuration::Rig& rig, const Accuracy& accuracy) {
  constexpr double kUniform = 1.0 / 3;
  std::vector<Inaccurate> cranes;
  for (const Candidate& candidate : inaccuracies_of(study.candidates(), rig, accuracy)) {
    if (!candidate.drive) continue;
    std::vector<double> values;
    for (const FreeParameter& p : candidate.parameters) values.push_back(p.null);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const FreeParameter& p = candidate.parameters[i];
      if (!(p.high > p.null)) continue;
      std::vector<double> wrong = values;
      wrong[i] = p.high;
      const bool one_of_two = candidate.law == GoesWith::speed;
      cranes.push_back({crane, one_of_two ? kUniform / 2 : kUniform});
      cranes.back().crane.terms.push_back(candidate.setting(wrong));
    }
  }
  return cranes;
}

/// Mean variance of the position in a window whose start (position and speed) is estimated, for a random
/// acceleration with standard deviation 1: s^2 (m/s2 to m). The acceleration has an exponential
/// autocorrelation. @param correlation_s  correlation time; 0: white, constant over one period
double variance_by_random_acceleration(double window_s, double correlation_s, double period_s) {
  constexpr Eigen::Index kPoints = 40;
  const double step_s = window_s / kPoints;
  Eigen::MatrixXd covariance(kPoints, kPoints), twice_integrated = Eigen::MatrixXd::Zero(kPoints, kPoints);
  Eigen::MatrixXd start(kPoints, 2);
  const double time_s = std::max(correlation_s, 0.5 * period_s);
  for (Eigen::Index i = 0; i < kPoints; ++i) {
    start.row(i) << 1, static_cast<double>(i) - 0.5 * (kPoints - 1);
    for (Eigen::Index j = 0; j < kPoints; ++j) {
      covariance(i, j) = std::exp(-std::abs(static_cast<double>(i - j)) * step_s / time_s);
      if (j < i) twice_integrated(i, j) = static_cast<double>(i - j) * step_s * step_s;
    }
  }
  // A correlation shorter than a step: the same spectral density at low frequencies.
  covariance *= std::min(1.0, 2 * time_s / step_s);
  start.colwise().normalize();
  const Eigen::MatrixXd left = twice_integrated - start * (start.transpose() * twice_integrated);
  return (left * covariance * left.transpose()).trace() / static_cast<double>(kPoints);
}

/// Standard deviation of the learnt disturbance of a drive, at most the credible one, m/s2 or rad/s2.
double credible_acceleration(const Disturbance& learnt, Output output, const configuration::Rig& rig) {
  const bool slews = output == kSlewAngle;
  const double gain = slews ? rig.plant.slew_gain_radps2pv : rig.plant.trolley_gain_mps2pv;
  const double volts = rig.drives[slews ? plant::kSlew : plant::kTrolley].volt_limit_v;
  return std::min(learnt.acceleration, rules::kCredibleDrive * gain * volts);
}

bool may_have_lost_edge(const Run& run, const Window& window, Output drive) {
  for (std::size_t k = window.first; k < window.first + window.rows; ++k)
    if (run.may_have_lost_edge(drive, k)) return true;
  return false;
}

}  // namespace

std::vector<DriveError> drive_errors(const WhitenedData& data, const Crane& crane,
                                     const configuration::Rig& rig, const Accuracy& accuracy) {
  std::vector<DriveError> errors;
  if (data.drive().empty()) return errors;
  const Problem& plain = data.study().train().drive;
  const Fits base = plain.fit(replays_of(plain.runs(), crane));
  const std::vector<Inaccurate> inaccurate = inaccurate_cranes(data.study(), crane, rig, accuracy);
  std::vector<Fits> wrong;
  for (const Inaccurate& one : inaccurate)
    wrong.push_back(plain.fit_near(replays_of(plain.runs(), one.crane), base));
  for (std::size_t output = 0; output < plain.outputs().size(); ++output) {
    DriveError& error = errors.emplace_back();
    error.output = plain.outputs()[output];
    const Disturbance& learnt = data.drive().disturbances()[output];
    const double acceleration = credible_acceleration(learnt, error.output, rig);
    std::vector<double> by_accuracy, by_force;
    double motion = 0;
    for (std::size_t w = 0; w < base.size(); ++w) {
      const Window& window = plain.windows()[w];
      if (may_have_lost_edge(plain.runs()[window.run].run, window, error.output)) continue;
      error.rms.push_back(
          std::sqrt(mean_square(plain, w, output, plain.measured(window) - base[w].simulated)));
      double variance = 0;
      for (std::size_t i = 0; i < wrong.size(); ++i)
        variance +=
            inaccurate[i].variance * mean_square(plain, w, output, wrong[i][w].simulated - base[w].simulated);
      by_accuracy.push_back(variance);
      const double period_s = plain.runs()[window.run].run.period_s;
      by_force.push_back(squared(acceleration) *
                         variance_by_random_acceleration(static_cast<double>(window.rows) * period_s,
                                                         learnt.correlation_s, period_s));
      const Eigen::VectorXd measured = plain.measured_values(window, output);
      motion += (measured.array() - measured.mean()).square().mean();
    }
    const double windows = static_cast<double>(std::max<std::size_t>(1, by_accuracy.size())),
                 usual = std::accumulate(by_accuracy.begin(), by_accuracy.end(), 0.0) / windows;
    for (std::size_t w = 0; w < by_accuracy.size(); ++w)
      error.expected.push_back(std::sqrt(squared(learnt.noise) + by_force[w] +
                                         squared(permitted_share(accuracy)) * motion / windows +
                                         std::max(by_accuracy[w], usual)));
  }
  return errors;
}

double p_value(const DriveError& error) {
  double exceeding = 0;
  for (std::size_t w = 0; w < error.rms.size(); ++w)
    exceeding += error.rms[w] > rules::kDriveError * error.expected[w] ? 1 : 0;
  if (exceeding == 0) return 1;
  const double one_window = std::erfc(rules::kDriveError / std::numbers::sqrt2);
  return boost::math::ibeta(exceeding, static_cast<double>(error.rms.size()) - exceeding + 1, one_window);
}

std::optional<SignificantDriveError> significant_drive_error(const WhitenedData& data, const Crane& crane,
                                                             const configuration::Rig& rig,
                                                             const Accuracy& accuracy) {
  const std::vector<DriveError> errors = drive_errors(data, crane, rig, accuracy);
  for (const DriveError& error : errors) {
    if (p_value(error) * static_cast<double>(errors.size()) > rules::kSignificant) continue;
    std::size_t worst = 0;
    for (std::size_t w = 0; w < error.rms.size(); ++w)
      if (error.rms[w] * error.expected[worst] > error.rms[worst] * error.expected[w]) worst = w;
    const char* const unit = error.output == kSlewAngle ? " rad" : " m";
    return SignificantDriveError{
        error.output,
        (std::ostringstream{} << std::setprecision(2) << "the simulation misses "
                              << kOutputNames[error.output] << " by " << error.rms[worst] << unit
                              << " rms in a window; noise and accuracy of the rig file explain "
                              << error.expected[worst] << unit)
            .str()};
  }
  return std::nullopt;
}

}  // namespace crane::diagnosis
