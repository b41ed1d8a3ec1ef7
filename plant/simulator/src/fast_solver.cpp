/// The fast method: one-step formulas with error control (one_step_formulas.hpp). Each step takes the cheaper
/// formula.
///
/// Explicit, Dormand and Prince, order 5(4): a tick of 10 ms without standstill is one step of 7 evaluations.
///
/// Implicit, RODAS, order 4(3), L-stable: at standstill the friction of an axis rises steeply with its speed
/// and limits an explicit step to less than 1 ms. A tick at rest is one implicit step of 16 evaluations.
///
/// An event ends the step in which a watched distance changes its sign. The time of the event is found by
/// repeating the step with other lengths.
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "one_step_formulas.hpp"
#include "solver.hpp"

namespace crane::simulator {
namespace {

using plant::Axis;
using plant::kAxes;

/// The explicit formula is stable up to 3.3 on the negative real axis.
constexpr double kMostExplicit = 2;
/// Difference for slopes [m, rad, per second]; small compared with every smoothing speed of the terms.
constexpr double kDifference = 1.5e-8;
/// Permitted local error / tolerance of CVODE: with it, the errors of whole maneuvers are those of CVODE
/// (integrator_test.cpp), which adds up the errors of many more steps. The flanks of a backlash are kinks,
/// at which an estimate of the error is too small.
constexpr double kPermitted = 100, kPermittedWithKinks = 10;
/// A shorter step than this [s] means that the equations have no solution any more.
constexpr double kShortest_s = 1e-11;
/// The time of an event is found to this [s].
constexpr double kEventTime_s = 1e-13;
constexpr int kMostEventTrials = 60;

/// @tparam kInner  0, or the most inner coordinates that a model can have; those that it has not stay 0
template <std::size_t kInner>
class FastSolver final : public Solver {
 public:
  FastSolver(const plant::Model& model, const Tolerances& tolerances)
      : model_(model), tolerances_(tolerances) {}

  Advance advance(Motion& motion, const plant::Actuation& actuation, double span_s,
                  const Watch& watch) override {
    actuation_ = &actuation;
    watch_ = watch.active() ? &watch : nullptr;
    store(motion, kInner, y_.data());
    slope_ = slope_at(y_);
    double left_s = span_s, h = span_s;
    std::optional<Event> event;
    while (left_s > 0 && !event) {
      h = std::min(h, left_s);
      if (h < left_s && left_s < 2 * h) h = left_s / 2;
      const Trial trial = step(h);
      if (!(trial.error <= 1)) {
        h *= growth(trial);
        if (!(h > kShortest_s)) fail();
        continue;
      }
      const auto [reached_s, end, found] = first_event(h, trial);
      left_s -= reached_s;
      y_ = end;
      event = found;
      if (left_s > 0 && !event) slope_ = slope_at(y_);
      h *= growth(trial);
    }
    motion = motion_of(y_.data(), kInner);
    return {.elapsed_s = event ? span_s - left_s : span_s, .event = event};
  }
  [[nodiscard]] long evaluations() const noexcept override { return evaluations_; }

 private:
  static constexpr std::size_t kHalf = kRigid + kInner;
  using Matrix = Eigen::Matrix<double, kHalf, kHalf>;
  using Vector = std::array<double, 2 * kHalf>;

  struct Trial {
    Vector end{};
    double error = 0;  ///< largest local error / permitted error
    double order = 0;  ///< the error grows with h^order
  };
  struct Reached {
    double after_s;
    Vector end;
    std::optional<Event> event;
  };

  [[nodiscard]] Vector slope_at(const Vector& y) {
    ++evaluations_;
    const Motion motion = motion_of(y.data(), kInner);
    plant::InnerAccelerations own{};
    const plant::Accelerations a = model_.accelerations(motion.state, *actuation_, motion.inner, own);
    Vector slope;
    std::copy_n(y.begin() + kHalf, kHalf, slope.begin());
    const std::array<double, kRigid> rigid{a.trolley_mps2, a.radial_radps2, a.slew_radps2,
                                           a.tangential_radps2, a.cable_mps2};
    std::copy(rigid.begin(), rigid.end(), slope.begin() + kHalf);
    std::copy_n(own.begin(), kInner, slope.begin() + kHalf + kRigid);
    return slope;
  }

  static void add(Vector& y, double factor, const Vector& k) {
    for (std::size_t i = 0; i < y.size(); ++i) y[i] += factor * k[i];
  }

  [[nodiscard]] Trial step(double h) {
    implicit_ = h * steepest() > kMostExplicit;
    if (!implicit_) return explicit_step(h);
    find_jacobian();
    return implicit_step(h);
  }
  [[nodiscard]] Trial repeated(double h) { return implicit_ ? implicit_step(h) : explicit_step(h); }

  /// Largest rate [1/s] at which the friction of a drive alone brings its speed to rest.
  [[nodiscard]] double steepest() const {
    const plant::Parameters& p = model_.parameters();
    const plant::PerAxis gain{p.trolley_gain_mps2pv, p.slew_gain_radps2pv,
                              p.hoist_gain_mpspv / p.hoist_lag_s};
    plant::State state = motion_of(y_.data(), kInner).state;
    double most = 0;
    for (std::size_t i = 0; i < kAxes; ++i) {
      const auto axis = static_cast<Axis>(i);
      if (actuation_->locks.axis[i]) continue;
      double& v = state.*plant::kAxisSpeed[i];
      const double kept = v;
      const double before = model_.friction_v(state, actuation_->drive_v[i], axis);
      v += kDifference;
      const double after = model_.friction_v(state, actuation_->drive_v[i], axis);
      most = std::max(most, gain[i] * (after - before) / (v - kept));
      v = kept;
    }
    return most;
  }

  [[nodiscard]] Trial explicit_step(double h) {
    using F = DormandPrince;
    std::array<Vector, F::kStages> k;
    k[0] = slope_;
    Trial trial{.end = y_, .order = 5};
    for (std::size_t i = 1; i < F::kStages; ++i) {
      Vector at = y_;
      for (std::size_t j = 0; j < i; ++j)
        if (F::kA[i][j] != 0) add(at, h * F::kA[i][j], k[j]);
      k[i] = slope_at(at);
      trial.end = at;  // the last stage is the result
    }
    Vector error{};
    for (std::size_t i = 0; i < F::kStages; ++i) add(error, h * F::kError[i], k[i]);
    trial.error = scaled(error, trial.end);
    return trial;
  }

  /// J = [0 I; A B], A = d q''/d q, B = d q''/d q', by forward differences. A coordinate that does not move
  /// has columns of 0: they are not used.
  void find_jacobian() {
    Vector at = y_;
    for (std::size_t i = 0; i < 2 * kHalf; ++i) {
      auto& block = i < kHalf ? by_position_ : by_rate_;
      const auto column = static_cast<Eigen::Index>(i % kHalf);
      if (is_fixed(i % kHalf)) {
        block.col(column).setZero();
        continue;
      }
      const double kept = at[i];
      at[i] += kDifference * std::max(1.0, std::abs(kept));
      const double inverse = 1 / (at[i] - kept);
      const Vector moved = slope_at(at);
      for (std::size_t j = 0; j < kHalf; ++j)
        block(static_cast<Eigen::Index>(j), column) = (moved[kHalf + j] - slope_[kHalf + j]) * inverse;
      at[i] = kept;
    }
  }
  [[nodiscard]] bool is_fixed(std::size_t coordinate) const {
    if (coordinate >= kRigid) return coordinate - kRigid >= model_.inner_coordinates();
    const plant::Locks& locks = actuation_->locks;
    const std::array<bool, kRigid> locked{locks.axis[plant::kTrolley], locks.radial, locks.axis[plant::kSlew],
                                          locks.tangential, locks.axis[plant::kHoist]};
    return locked[coordinate];
  }

  /// With w = 1 / (h gamma): (w - B - A / w) u_v = r_v + A r_p / w,  u_p = (r_p + u_v) / w
  [[nodiscard]] Trial implicit_step(double h) {
    using F = Rodas;
    const double w = 1 / (h * F::kGamma), inverse_w = h * F::kGamma;
    lu_.compute(w * Matrix::Identity() - by_rate_ - inverse_w * by_position_);
    std::array<Vector, F::kStages> u;
    Trial trial{.end = y_, .order = 4};
    for (std::size_t i = 0; i < F::kStages; ++i) {
      Vector at = y_;
      for (std::size_t j = 0; j < i; ++j)
        if (F::kA[i][j] != 0) add(at, F::kA[i][j], u[j]);
      Vector r = i == 0 ? slope_ : slope_at(at);
      for (std::size_t j = 0; j < i; ++j) add(r, F::kC[i][j] / h, u[j]);
      u[i] = solved(r, inverse_w);
      trial.end = at;
    }
    add(trial.end, 1, u.back());
    trial.error = scaled(u.back(), trial.end);
    return trial;
  }
  [[nodiscard]] Vector solved(const Vector& r, double inverse_w) const {
    using Half = Eigen::Matrix<double, kHalf, 1>;
    const Eigen::Map<const Half> of_positions(r.data()), of_rates(&r[kHalf]);
    const Half rates = lu_.solve(of_rates + inverse_w * (by_position_ * of_positions));
    Vector u;
    for (std::size_t i = 0; i < kHalf; ++i) {
      const double rate = rates[static_cast<Eigen::Index>(i)];
      u[i] = (r[i] + rate) * inverse_w;
      u[kHalf + i] = rate;
    }
    return u;
  }

  [[nodiscard]] double scaled(const Vector& error, const Vector& end) const {
    double most = 0;
    for (std::size_t i = 0; i < error.size(); ++i) {
      const double ratio =
          std::abs(error[i]) / (tolerances_.absolute + tolerances_.relative * std::abs(end[i]));
      if (!(ratio <= most)) most = ratio;  // also when it is no number
    }
    return most / (kInner == 0 ? kPermitted : kPermittedWithKinks);
  }

  /// Factor of the next step's length.
  [[nodiscard]] static double growth(const Trial& trial) {
    constexpr double kSafety = 0.9, kLeast = 0.2, kMost = 5;
    if (!std::isfinite(trial.error)) return kLeast;
    if (trial.error == 0) return kMost;
    return std::clamp(kSafety * std::pow(trial.error, -1 / trial.order), kLeast, kMost);
  }

  /// End of a step that begins at y_: whole, or at the first event in it.
  [[nodiscard]] Reached first_event(double h, const Trial& trial) {
    Reached first{h, trial.end, std::nullopt};
    if (watch_ == nullptr) return first;
    std::array<double, kDistances> before{}, after{};
    measure_distances(*watch_, y_.data(), kHalf, before.data());
    measure_distances(*watch_, trial.end.data(), kHalf, after.data());
    for (std::size_t i = 0; i < kDistances; ++i) {
      if (before[i] * after[i] > 0 || before[i] == 0) continue;
      const auto [after_s, end] = crossing(i, before[i], h, trial.end, after[i]);
      if (first.event && after_s >= first.after_s) continue;
      first = {after_s, end, event_of(i)};
    }
    return first;
  }

  /// Illinois method for the length of the step at whose end the distance is 0 or has just changed its sign.
  std::pair<double, Vector> crossing(std::size_t distance, double low_value, double high, const Vector& end,
                                     double high_value) {
    double low = 0;
    Vector reached = end;
    int side = 0;  // end of the interval that the last trial has moved
    for (int trial = 0; trial < kMostEventTrials && high - low > kEventTime_s && high_value != 0; ++trial) {
      const double at = high - high_value * (high - low) / (high_value - low_value);
      const Vector there = repeated(at).end;
      std::array<double, kDistances> value{};
      measure_distances(*watch_, there.data(), kHalf, value.data());
      if (value[distance] * low_value > 0) {
        low = at;
        low_value = value[distance];
        if (side < 0) high_value /= 2;
        side = -1;
      } else {
        high = at;
        high_value = value[distance];
        reached = there;
        if (side > 0) low_value /= 2;
        side = 1;
      }
    }
    return {high, reached};
  }

  [[noreturn]] static void fail() {
    throw std::runtime_error(
        "fast integrator: the step size becomes too small (a swing angle at 90 degrees, or cable length 0)");
  }

  const plant::Model& model_;
  Tolerances tolerances_;
  const plant::Actuation* actuation_ = nullptr;
  const Watch* watch_ = nullptr;
  Vector y_{}, slope_{};  ///< at the beginning of the step
  /// A and B at the beginning of an implicit step.
  Matrix by_position_ = Matrix::Zero(), by_rate_ = Matrix::Zero();
  Eigen::PartialPivLU<Matrix> lu_;
  bool implicit_ = false;  ///< formula of the last step
  long evaluations_ = 0;
};

}  // namespace

std::unique_ptr<Solver> make_fast_solver(const plant::Model& model, const Tolerances& tolerances) {
  if (model.inner_coordinates() == 0) return std::make_unique<FastSolver<0>>(model, tolerances);
  return std::make_unique<FastSolver<plant::kMostInner>>(model, tolerances);
}

}  // namespace crane::simulator
