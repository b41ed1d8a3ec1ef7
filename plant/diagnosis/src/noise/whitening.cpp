#include "noise/whitening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "parallel.hpp"
#include "robust.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kSweeps = 8;
/// Of the speed of a drive's residual.
constexpr std::array kDampings_ps{0.0, 1.0, 4.0, 12.0};
/// Of the force; 0: white.
constexpr std::array kCorrelations_s{0.0, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0};
/// Decrease of minus twice the log likelihood that asks for another sweep.
constexpr double kWorthASweep = 1;
/// Share of what friction does at standstill that is left when an axis stands: it creeps, the model's
/// otherwise.
constexpr double kCreep = 0.01;
/// Variance of an unknown start, in noise variances (of position, and of the way the speed makes in a row).
constexpr double kUnknownStart = 1e8;

/// From row to row: position and speed of the residual, the force's acceleration.
Matrix3d step_of(const Disturbance& d, const Passage& passage) {
  const double t = passage.period_s, w = passage.natural_radps, c = d.damping_ps;
  const double kept = d.correlation_s > 0 ? std::exp(-t / d.correlation_s) : 0;
  Matrix3d step;
  if (w > 0) {
    step << std::cos(w * t), std::sin(w * t) / w, (1 - std::cos(w * t)) / (w * w),  //
        -w * std::sin(w * t), std::cos(w * t), std::sin(w * t) / w,                 //
        0, 0, kept;
  } else if (c * t < 1e-6) {
    step << 1, t, 0.5 * t * t,  //
        0, 1, t,                //
        0, 0, kept;
  } else {
    const double slowed = std::exp(-c * t), way = (1 - slowed) / c;
    step << 1, way, (t - way) / c,  //
        0, slowed, way,             //
        0, 0, kept;
  }
  return step;
}

/// Covariance of the filter's prediction along a window. It does not depend on the residual.
class Prediction {
 public:
  /// @param start_variance of position, and of the way that the speed makes in a row
  Prediction(const Disturbance& d, const Passage& passage, double start_variance)
      : d_(d), passage_(passage), step_(step_of(d, passage)) {
    const double a = d.acceleration * d.acceleration, t = passage.period_s;
    covariance_.diagonal() << start_variance, start_variance / (t * t), a;
    fresh_ = a * (1 - step_(2, 2) * step_(2, 2));
    friction_ = std::pow(d.friction * t, 2);
  }
  /// Of the next residual, noise included.
  [[nodiscard]] double variance() const { return covariance_(0, 0) + d_.noise * d_.noise; }
  [[nodiscard]] Vector3d gain() const { return covariance_.col(0) / variance(); }
  [[nodiscard]] Going going(std::size_t row) const {
    return d_.sticks ? passage_.paces[row].going : Going::on;
  }
  void advance(std::size_t row) {
    if (passage_.paces[row].seen) {
      const Vector3d seen = covariance_.col(0);
      covariance_ -= seen * seen.transpose() / variance();
    }
    if (going(row) != Going::on) {
      covariance_.row(1).setZero();
      covariance_.col(1).setZero();
    }
    const double share = going(row) == Going::standing ? kCreep : passage_.paces[row].slow;
    covariance_(1, 1) += friction_ * share;
    covariance_ = step_ * covariance_ * step_.transpose();
    covariance_(2, 2) += fresh_;
  }

 private:
  const Disturbance& d_;
  const Passage& passage_;
  Matrix3d step_, covariance_ = Matrix3d::Zero();
  double fresh_ = 0, friction_ = 0;
};

Vector3d advanced(const Matrix3d& step, Vector3d state, Going going) {
  if (going != Going::on) state[1] = 0;
  return step * state;
}

/// Minus twice the log likelihood; the disturbance has noise 1, the common scale is profiled out. The scale
/// is that whose mean loss is a normal residual's, so that slips count little.
struct Likelihood {
  double value = std::numeric_limits<double>::infinity();
  double variance = 0;
};

/// Squares of innovations over their variances, after two measured rows that solve for the start. A row that
/// was not measured tells nothing.
struct Innovations {
  std::vector<double> squares;
  double logs = 0;  ///< of the variances
};

Innovations innovations(const VectorXd& residual, const Passage& passage, const Disturbance& d) {
  constexpr std::size_t kStart = 2;
  Innovations all;
  Prediction prediction(d, passage, kUnknownStart);
  const Matrix3d step = step_of(d, passage);
  Vector3d state = Vector3d::Zero();
  std::size_t seen = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(residual.size()); ++k) {
    if (passage.paces[k].seen) {
      const double surprise = residual[static_cast<Index>(k)] - state[0], f = prediction.variance();
      if (seen++ >= kStart) {
        all.logs += std::log(f);
        all.squares.push_back(surprise * surprise / f);
      }
      state += prediction.gain() * surprise;
    }
    state = advanced(step, state, prediction.going(k));
    prediction.advance(k);
  }
  return all;
}

/// @param near a guess above 0
double robust_variance(const std::vector<Innovations>& of_windows, double near) {
  constexpr int kRounds = 30;
  constexpr double kExact = 1e-3;
  double variance = near;
  for (int round = 0; round < kRounds; ++round) {
    double loss = 0, count = 0;
    for (const Innovations& window : of_windows) {
      for (const double square : window.squares) loss += kFar * std::log1p(square / (kFar * variance));
      count += static_cast<double>(window.squares.size());
    }
    const double ratio = loss / (kMeanLoss * count);
    variance *= ratio;
    if (!(std::abs(ratio - 1) > kExact)) break;
  }
  return variance;
}

/// @param near a guess of the variance; 0: none
Likelihood likelihood(const std::vector<VectorXd>& residuals, const std::vector<Passage>& passages,
                      const Disturbance& d, double near) {
  std::vector<Innovations> of_windows(residuals.size());
  parallel_for(residuals.size(),
               [&](std::size_t w) { of_windows[w] = innovations(residuals[w], passages[w], d); });
  double logs = 0, squares = 0, count = 0;
  for (const Innovations& window : of_windows) {
    logs += window.logs;
    for (const double square : window.squares) squares += square;
    count += static_cast<double>(window.squares.size());
  }
  if (!(squares > 0)) return {};
  const double variance = robust_variance(of_windows, near > 0 ? near : squares / count);
  return {logs + count * std::log(variance), variance};
}

/// One number after the other, each on its grid, until nothing gets better. Accelerations are in noises.
class Learning {
 public:
  Learning(const std::vector<VectorXd>& residuals, const std::vector<Passage>& passages, double least_noise)
      : residuals_(residuals), passages_(passages), least_noise_(least_noise) {}

  Disturbance run(const Disturbance& near) {
    if (near.noise > 0) return search(in_noises(near));
    Disturbance start;
    start.noise = 1;
    start.correlation_s = 0.2;
    Disturbance best = search(start);
    if (pendulum()) return best;
    const double without = found_.value;
    start.sticks = true;
    start.friction = 1;
    const Disturbance sticking = search(start);
    return found_.value < without ? sticking : best;
  }

 private:
  static Disturbance in_noises(Disturbance d) {
    d.acceleration /= d.noise;
    d.friction /= d.noise;
    d.noise = 1;
    return d;
  }

  Disturbance search(const Disturbance& start) {
    best_ = start;
    found_ = {};
    found_ = likelihood(residuals_, passages_, best_, found_.variance);
    if (best_.acceleration == 0) begin();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      const double before = found_.value;
      for (const double factor : {0.3, 0.7, 1.4, 3.0})
        try_with(best_.acceleration, factor * best_.acceleration);
      for (const double correlation_s : kCorrelations_s) try_colour(correlation_s);
      if (!pendulum()) try_drive();
      if (before - found_.value < kWorthASweep) break;
    }
    Disturbance found = best_;
    const double noise = std::sqrt(found_.variance);
    found.acceleration *= noise;
    found.friction *= noise;
    found.noise = std::max(noise, least_noise_);
    found.misfit = std::isfinite(found_.value) ? found_.value : 0;  // residuals of nothing but zeros
    return found;
  }

  /// A force of some size and colour, what friction does in its measure: the likelihood has several summits,
  /// a weak slow force with a rough sensor is one, a strong fast one with a fine sensor another.
  void begin() {
    const Disturbance start = best_;
    const double share = start.friction;
    Disturbance likeliest = start;
    for (const double correlation_s : kCorrelations_s)
      for (int decade = -1; decade < 8; ++decade) {
        best_ = start;
        best_.correlation_s = correlation_s;
        best_.acceleration = std::pow(10, decade);
        best_.friction = share * best_.acceleration;
        const Likelihood tried = likelihood(residuals_, passages_, best_, found_.variance);
        if (tried.value < found_.value) found_ = tried, likeliest = best_;
      }
    best_ = likeliest;
  }

  /// A force that lasts longer and is as strong at low frequencies, with every damping.
  void try_colour(double correlation_s) {
    const Disturbance before = best_;
    const auto lasts = [](double s) { return std::max(s, kCorrelations_s[1] / 2); };
    const double weaker = std::sqrt(lasts(before.correlation_s) / lasts(correlation_s));
    for (const double share : {1.0, weaker})
      for (const double damping_ps : kDampings_ps) {
        if (pendulum() && damping_ps > 0) continue;
        Disturbance tried = before;
        tried.correlation_s = correlation_s;
        tried.acceleration *= share;
        tried.friction *= share;
        tried.damping_ps = damping_ps;
        const Likelihood found = likelihood(residuals_, passages_, tried, found_.variance);
        if (found.value < found_.value) found_ = found, best_ = tried;
      }
  }

  [[nodiscard]] bool pendulum() const { return passages_.at(0).natural_radps > 0; }

  void try_drive() {
    for (const double damping_ps : kDampings_ps) try_with(best_.damping_ps, damping_ps);
    for (const double share : {0.0, 0.3, 1.0, 3.0, 10.0, 30.0})
      try_with(best_.friction, share * best_.acceleration);
  }

  /// Keeps `value` in `number`, one of those of the best, if it makes the residuals likelier.
  template <class Number>
  void try_with(Number& number, Number value) {
    const Number before = number;
    if (value == before) return;
    number = value;
    const Likelihood tried = likelihood(residuals_, passages_, best_, found_.variance);
    if (tried.value < found_.value)
      found_ = tried;
    else
      number = before;
  }

  const std::vector<VectorXd>& residuals_;
  const std::vector<Passage>& passages_;
  double least_noise_;
  Disturbance best_;
  Likelihood found_;
};

}  // namespace

Disturbance learn(const std::vector<VectorXd>& residuals, const std::vector<Passage>& passages,
                  double least_noise, const Disturbance& near) {
  return Learning(residuals, passages, least_noise).run(near);
}

Whitener::Whitener(const Disturbance& disturbance, const Passage& passage)
    : step_(step_of(disturbance, passage)) {
  Prediction prediction(disturbance, passage, 0);
  for (std::size_t k = 0; k < passage.paces.size(); ++k) {
    if (passage.paces[k].seen)
      rows_.push_back({prediction.gain(), 1 / std::sqrt(prediction.variance()), prediction.going(k)});
    else
      rows_.push_back({Vector3d::Zero(), 0, prediction.going(k)});
    prediction.advance(k);
  }
}

void Whitener::apply(Eigen::Ref<MatrixXd> x) const {
  for (Index column = 0; column < x.cols(); ++column) {
    Vector3d state = Vector3d::Zero();
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      double& value = x(static_cast<Index>(k), column);
      const Row& row = rows_[k];
      const double surprise = value - state[0];
      value = surprise * row.inverse_sd;
      state = advanced(step_, state + row.gain * surprise, row.going);
    }
  }
}

}  // namespace crane::diagnosis
