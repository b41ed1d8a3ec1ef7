#include "noise/filter.hpp"

#include <cmath>

namespace crane::diagnosis {
namespace {

/// Share of u at rest, where the measured axis creeps and the model sticks.
constexpr double kStandingFrictionShare = 0.01;
/// Variance of the distance in a row after a lost edge of the command, in noise variances.
constexpr double kUnknownSpeedVariance = 1e6;
/// Relative change of the variances per row in the steady state of the filter.
constexpr double kSteadyStateTolerance = 1e-9;

bool steady(double before, double after) {
  return std::abs(after - before) <= kSteadyStateTolerance * before;
}

}  // namespace

Eigen::Matrix3d transition_of(const Disturbance& d, const WindowMotion& motion) {
  const double t = motion.period_s, w = motion.natural_radps, c = d.damping_ps;
  const double kept = d.correlation_s > 0 ? std::exp(-t / d.correlation_s) : 0;
  Eigen::Matrix3d step;
  if (w > 0) {
    step << std::cos(w * t), std::sin(w * t) / w, (1 - std::cos(w * t)) / (w * w),  //
        -w * std::sin(w * t), std::cos(w * t), std::sin(w * t) / w,                 //
        0, 0, kept;
  } else if (c * t < 1e-6) {
    step << 1, t, 0.5 * t * t,  //
        0, 1, t,                //
        0, 0, kept;
  } else {
    const double slowed = std::exp(-c * t), distance = (1 - slowed) / c;
    step << 1, distance, (t - distance) / c,  //
        0, slowed, distance,                  //
        0, 0, kept;
  }
  return step;
}

PredictionCovariance::PredictionCovariance(const Disturbance& d, const WindowMotion& motion,
                                           double start_variance)
    : motion_(motion),
      sticks_(d.sticks),
      step_(transition_of(d, motion)),
      noise_variance_(d.noise * d.noise),
      unit_(d.unit) {
  const double a = d.acceleration * d.acceleration, t = motion.period_s;
  become({.xx = start_variance, .vv = start_variance / (t * t), .aa = a});
  process_noise_ = a * (1 - step_(2, 2) * step_(2, 2));
  friction_ = std::pow(d.friction * t, 2);
  unknown_speed_ = kUnknownSpeedVariance * noise_variance_ / (t * t);
}

void PredictionCovariance::become(const Symmetric& p) {
  p_ = p;
  variance_ = p.xx + noise_variance_;
  gain_ = Eigen::Vector3d{p.xx, p.xv, p.xa} / variance_;
}

PredictionCovariance::Symmetric PredictionCovariance::propagated(const Symmetric& p) const {
  const auto row = [&](int i) {
    const double x = step_(i, 0), v = step_(i, 1), a = step_(i, 2);
    return Eigen::Vector3d{x * p.xx + v * p.xv + a * p.xa, x * p.xv + v * p.vv + a * p.va,
                           x * p.xa + v * p.va + a * p.aa};
  };
  const Eigen::Vector3d x = row(0), v = row(1);
  const double kept = step_(2, 2);
  return {.xx = step_(0, 0) * x[0] + step_(0, 1) * x[1] + step_(0, 2) * x[2],
          .xv = step_(1, 0) * x[0] + step_(1, 1) * x[1] + step_(1, 2) * x[2],
          .xa = kept * x[2],
          .vv = step_(1, 0) * v[0] + step_(1, 1) * v[1] + step_(1, 2) * v[2],
          .va = kept * v[2],
          .aa = kept * kept * p.aa};
}

void PredictionCovariance::advance(std::size_t row) {
  const RowMotion& row_motion = motion_.profile[row];
  const MotionPhase now = phase(row);
  const double friction =
      friction_ * (now == MotionPhase::standing ? kStandingFrictionShare : row_motion.slowness);
  // In a row of ordinary motion, the filter keeps its steady state.
  const double inaccuracy = row_motion.speed_inaccuracy / unit_;
  const bool usual = row_motion.measured && now == MotionPhase::moving && friction == 0 && inaccuracy == 0 &&
                     !row_motion.speed_unknown;
  if (usual && steady_) return;
  Symmetric p = p_;
  if (row_motion.measured) {
    const double f = variance();
    p.xx -= p_.xx * p_.xx / f;
    p.xv -= p_.xx * p_.xv / f;
    p.xa -= p_.xx * p_.xa / f;
    p.vv -= p_.xv * p_.xv / f;
    p.va -= p_.xv * p_.xa / f;
    p.aa -= p_.xa * p_.xa / f;
  }
  if (now != MotionPhase::moving) p.xv = p.vv = p.va = 0;
  p.vv += friction + inaccuracy * inaccuracy + (row_motion.speed_unknown ? unknown_speed_ : 0);
  p = propagated(p);
  p.aa += process_noise_;
  steady_ = usual && steady(p_.xx, p.xx) && steady(p_.vv, p.vv) && steady(p_.aa, p.aa);
  become(p);
}

}  // namespace crane::diagnosis
