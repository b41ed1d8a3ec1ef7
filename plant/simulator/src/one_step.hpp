#pragma once
/// One step of the fast method (fast_solver.cpp) with either formula of one_step_formulas.hpp, and its error.
///
/// Explicit, Dormand and Prince, order 5(4): a tick of 10 ms without standstill is one step of 7 evaluations.
///
/// Linearly implicit, Rosenbrock-W, order 3(2): at standstill the friction of a drive rises steeply with its
/// speed and limits an explicit step to less than 1 ms. The matrix J of the formula contains this rise only,
/// so that a step costs 4 evaluations and the inverse of a 3x3 matrix.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "one_step_formulas.hpp"
#include "solver.hpp"

namespace crane::simulator {

/// Largest step times steepest rate for the explicit formula, which is stable up to 3.3 on the negative real
/// axis.
inline constexpr double kMostExplicit = 2;
/// Difference for the slope of the friction [m/s, rad/s]; small compared with every smoothing speed of the
/// terms.
inline constexpr double kDifference = 1.5e-8;
/// Permitted local error / tolerance of CVODE. With this ratio, whole motions are as accurate as with CVODE,
/// which accumulates the errors of many more steps (fast_integrator_test.cpp).
inline constexpr double kPermitted = 10;
/// A step shorter than this [s] indicates that the equations have no solution.
inline constexpr double kShortest_s = 1e-11;

/// @tparam kInner  0, or the largest number of inner coordinates of a model; unused coordinates remain 0
template <std::size_t kInner>
class OneStep {
 public:
  static constexpr std::size_t kHalf = kRigid + kInner;
  using Half = std::array<double, kHalf>;
  using Vector = std::array<double, 2 * kHalf>;

  struct Slope {
    Vector y{};                   ///< y'
    plant::PerAxis friction_v{};  ///< friction of the drives that y' contains
  };
  struct Trial {
    Vector end{};
    double error = 0;  ///< largest local error / permitted error
    double order = 0;  ///< the error grows with h^order
    Slope at_end{};    ///< explicit step only
  };

  OneStep(const plant::Model& model, const Tolerances& tolerances) : model_(model), tolerances_(tolerances) {}

  /// Begins a span with constant actuation. `actuation` must outlive the span.
  void begin_span(const Motion& motion, const plant::Actuation& actuation) {
    actuation_ = &actuation;
    store(motion, kInner, y_.data());
    begin_step_at(slope_at(y_));
    response_known_ = false;
  }
  /// Selects the cheaper formula for a step of length h. @return length of the step, at most h
  [[nodiscard]] double select_formula(double h) {
    implicit_ = h * steepest_1ps_ > kMostExplicit;
    // An explicit step would not detect the steep friction of a drive that comes to rest within the step.
    if (!implicit_) h = std::min(h, standstill_s());
    if (implicit_ && !response_known_) find_response();
    return h;
  }
  /// Computes a step of length h from y() with the selected formula; y() does not change.
  [[nodiscard]] Trial step(double h) { return implicit_ ? implicit_step(h) : explicit_step(h); }
  /// Ends the step at `end`.
  void end_step(const Vector& end) { y_ = end; }
  /// Begins the next step at y(), the end of `trial`.
  void begin_step_after(const Trial& trial) { begin_step_at(implicit_ ? slope_at(y_) : trial.at_end); }

  [[nodiscard]] const Vector& y() const noexcept { return y_; }
  [[nodiscard]] long evaluations() const noexcept { return evaluations_; }

 private:
  using Axis = plant::Axis;
  static constexpr std::size_t kAxes = plant::kAxes;
  using AxisMatrix = Eigen::Matrix<double, kAxes, kAxes>;

  [[nodiscard]] Slope slope_at(const Vector& y) {
    const Motion motion = motion_of(y.data(), kInner);
    Slope slope{.friction_v = model_.free_drives_friction_v(motion.state, *actuation_)};
    const Half accelerations = accelerations_at(motion, slope.friction_v);
    std::copy_n(y.begin() + kHalf, kHalf, slope.y.begin());
    std::copy_n(accelerations.begin(), kHalf, slope.y.begin() + kHalf);
    return slope;
  }
  [[nodiscard]] Half accelerations_at(const Motion& motion, const plant::PerAxis& friction_v) {
    ++evaluations_;
    plant::InnerAccelerations own{};
    const plant::Accelerations a =
        model_.accelerations(motion.state, *actuation_, friction_v, motion.inner, own);
    Half all{a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, a.cable_mps2};
    std::copy_n(own.begin(), kInner, all.begin() + kRigid);
    return all;
  }

  static void add(Vector& y, double factor, const Vector& k) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * k[i];
  }

  void begin_step_at(const Slope& slope) {
    slope_ = slope;
    find_steepness();
  }
  /// Time until the first free drive would come to rest with its present acceleration.
  [[nodiscard]] double standstill_s() const {
    double first_s = std::numeric_limits<double>::infinity();
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const std::size_t i = kHalf + plant::kPositionIndex[axis];
      const double rest_s = -y_[i] / slope_.y[i];
      if (!actuation_->locks.axis[axis] && rest_s > kShortest_s) first_s = std::min(first_s, rest_s);
    }
    return first_s;
  }

  /// d friction / d speed of each drive, and the largest rate [1/s] at which the friction of a drive alone
  /// brings it to rest.
  void find_steepness() {
    const plant::Parameters& p = model_.parameters();
    const plant::PerAxis gain{p.trolley_gain_mps2pv, p.slew_gain_radps2pv,
                              p.hoist_gain_mpspv / p.hoist_lag_s};
    plant::State state = motion_of(y_.data(), kInner).state;
    steepest_1ps_ = 0;
    for (std::size_t i = 0; i < kAxes; ++i) {
      steepness_[i] = 0;
      if (actuation_->locks.axis[i]) continue;
      double& v = state.*plant::kAxisSpeed[i];
      const double kept = v;
      v += kDifference;
      const double after_v = model_.friction_v(state, actuation_->drive_v[i], static_cast<Axis>(i));
      steepness_[i] = (after_v - slope_.friction_v[i]) / (v - kept);
      steepest_1ps_ = std::max(steepest_1ps_, gain[i] * steepness_[i]);
      v = kept;
    }
  }

  /// d q'' / d friction of each drive. The friction enters linearly. The response depends on the position and
  /// is not updated within the span; the W-method permits this.
  void find_response() {
    const Motion motion = motion_of(y_.data(), kInner);
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      response_[axis] = {};
      if (actuation_->locks.axis[axis]) continue;
      plant::PerAxis more_v = slope_.friction_v;
      more_v[axis] += 1;
      const Half moved = accelerations_at(motion, more_v);
      for (std::size_t i = 0; i < kHalf; ++i) response_[axis][i] = moved[i] - slope_.y[kHalf + i];
    }
    response_known_ = true;
  }

  [[nodiscard]] Trial explicit_step(double h) {
    using F = DormandPrince;
    std::array<Vector, F::kStages> k;
    k[0] = slope_.y;
    Trial trial{.end = y_, .order = 5};
    for (std::size_t i = 1; i < F::kStages; ++i) {
      Vector at = y_;
      for (std::size_t j = 0; j < i; ++j)
        if (F::kA[i][j] != 0) add(at, h * F::kA[i][j], k[j]);
      trial.at_end = slope_at(at);
      k[i] = trial.at_end.y;
      trial.end = at;  // the last stage is the result
    }
    Vector error{};
    for (std::size_t i = 0; i < F::kStages; ++i) add(error, h * F::kError[i], k[i]);
    trial.error = scaled(error, trial.end);
    return trial;
  }

  /// With w = 1 / (h gamma), J = [0 I; 0 R S], the response R (find_response) and the steepness S = diag(s):
  ///   u_v = (r_v + R S t) / w,  u_p = (r_p + u_v) / w,  (w - R_a S) t = r_a,
  /// where a are the rows of the drives and t is u_v of the drives.
  [[nodiscard]] Trial implicit_step(double h) {
    using F = RosenbrockW;
    const double w = 1 / (h * F::kGamma);
    AxisMatrix matrix;
    for (std::size_t i = 0; i < kAxes; ++i)
      for (std::size_t j = 0; j < kAxes; ++j)
        matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
            (i == j ? w : 0) - response_[j][plant::kPositionIndex[i]] * steepness_[j];
    const AxisMatrix of_drives = matrix.inverse();
    std::array<Vector, F::kStages> u;
    Trial trial{.end = y_, .order = 3};
    for (std::size_t i = 0; i < F::kStages; ++i) {
      Vector at = y_;
      for (std::size_t j = 0; j < i; ++j)
        if (F::kA[i][j] != 0) add(at, F::kA[i][j], u[j]);
      Vector r = i == 0 ? slope_.y : slope_at(at).y;
      for (std::size_t j = 0; j < i; ++j) add(r, F::c(i, j) / h, u[j]);
      u[i] = solved(of_drives, r, h * F::kGamma);
      trial.end = at;
    }
    add(trial.end, 1, u.back());
    Vector error{};
    for (std::size_t i = 0; i < F::kStages; ++i) add(error, F::kError[i], u[i]);
    trial.error = scaled(error, trial.end);
    return trial;
  }
  [[nodiscard]] Vector solved(const AxisMatrix& of_drives, const Vector& r, double inverse_w) const {
    Eigen::Matrix<double, kAxes, 1> right;
    for (std::size_t i = 0; i < kAxes; ++i)
      right[static_cast<Eigen::Index>(i)] = r[kHalf + plant::kPositionIndex[i]];
    const Eigen::Matrix<double, kAxes, 1> drives = of_drives * right;
    Half rates;
    std::copy_n(r.begin() + kHalf, kHalf, rates.begin());
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const double friction_v = steepness_[axis] * drives[static_cast<Eigen::Index>(axis)];
      for (std::size_t i = 0; i < kHalf; ++i) rates[i] += response_[axis][i] * friction_v;
    }
    Vector u;
    for (std::size_t i = 0; i < kHalf; ++i) {
      u[kHalf + i] = rates[i] * inverse_w;
      u[i] = (r[i] + u[kHalf + i]) * inverse_w;
    }
    return u;
  }

  [[nodiscard]] double scaled(const Vector& error, const Vector& end) const {
    double most = 0;
    for (std::size_t i = 0; i < error.size(); ++i) {
      const double ratio =
          std::abs(error[i]) / (tolerances_.absolute + tolerances_.relative * std::abs(end[i]));
      if (!(ratio <= most)) most = ratio;  // also true for NaN
    }
    return most / kPermitted;
  }

  const plant::Model& model_;
  Tolerances tolerances_;
  const plant::Actuation* actuation_ = nullptr;
  // at the beginning of the step
  Vector y_{};
  Slope slope_{};
  plant::PerAxis steepness_{};  ///< d friction / d speed [V s/m, V s/rad]
  double steepest_1ps_ = 0;     ///< see find_steepness()
  /// d q'' / d friction [per V] of each drive, computed at one step of the span
  std::array<Half, kAxes> response_{};
  bool response_known_ = false;
  bool implicit_ = false;  ///< formula of the last step
  long evaluations_ = 0;
};

}  // namespace crane::simulator
