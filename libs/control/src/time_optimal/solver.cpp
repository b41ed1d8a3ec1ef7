#include "solver.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/plant/pendulum.hpp"

namespace crane::control::time_optimal {
namespace {

constexpr int kMostIterations = 150;
// Barrier parameter mu, s: objective T per bound and e-fold of the distance from the bound.
constexpr double kStartBarrier = 3e-3, kEndBarrier = 2e-5;
constexpr double kBarrierFactor = 0.3;
constexpr double kEffort = 5e-3;      // s: cost of full volts on both drives during the whole move
constexpr double kEndSlack = 1e-8;    // inverse weight of the end condition
constexpr double kToBoundary = 0.99;  // largest share of the distance to a bound in one step
constexpr double kClosed = 1e-4;      // sum of the absolute gaps of a solution, m, rad and their rates
constexpr double kMostChange = 0.2;   // largest relative change of T in one step
constexpr int kMostHalvings = 12;
constexpr double kDamping = 1e-7;  // regularisation of the Newton step, s/V^2
// The gaps close quickly with a fixed duration slightly above the optimum.
constexpr double kRoom = 1.003;        // duration / optimal duration
constexpr double kRoomBarrier = 1e-3;  // mu with a fixed duration: the objective is the barriers only
constexpr double kNearOptimum = 5e-3;  // relative change of T below which the duration is fixed
constexpr double kNearGaps = 0.3;      // sum of the gaps below which the duration is fixed
constexpr int kMostSearching = 60;     // iterations with free duration
constexpr int kMostClosing = 20;       // iterations with one fixed duration
constexpr double kMoreRoom = 1.01;     // factor of the duration when the gaps do not close

/// Gradient and curvature of the barriers of one value.
struct Barrier {
  double gradient, curvature;
};
Barrier barrier_of(double value, double low, double high, const Bounded& dual, double mu) noexcept {
  const double below = value - low, above = high - value;
  return {mu / above - mu / below, dual.low_dual / below + dual.high_dual / above};
}

double logarithms(double value, double low, double high) noexcept {
  return std::log(value - low) + std::log(high - value);
}

/// Share of `change` that moves the value by kToBoundary of its distance from a bound.
double share_within(double value, double change, double low, double high) noexcept {
  const double room = change > 0 ? high - value : value - low;
  return std::abs(change) > kToBoundary * room ? kToBoundary * room / std::abs(change) : 1;
}

/// Moves a dual variable z by the linearised complementarity (value - bound) z = mu; z stays positive.
void move_dual(double& dual, double room, double room_change, double mu) noexcept {
  const double change = (mu - dual * room_change) / room - dual;
  const double share = change < -kToBoundary * dual ? kToBoundary * dual / -change : 1;
  // stays near the central path: one unsuitable step must not distort the curvature
  dual = std::clamp(dual + share * change, mu / room / 1e8, mu / room * 1e8);
}

}  // namespace

Solver::Solver(const Design& design, const PlanProblem& problem) noexcept
    : tower_{design, problem.cable_m}, volt_limit_{problem.limits.volts[0], problem.limits.volts[1]} {
  constexpr double kFree = 1e3;  // rad/s: no limit on the swing rates
  const PlanLimits& l = problem.limits;
  from_ << problem.from[0], 0, problem.from[1], 0, 0, 0, 0, 0;
  to_ << problem.to[0], 0, problem.to[1], 0, 0, 0, 0, 0;
  high_ << l.high[0], l.swing_rad, l.high[1], l.swing_rad, l.speed[0], kFree, l.speed[1], kFree;
  low_ << l.low[0], -l.swing_rad, l.low[1], -l.swing_rad, -l.speed[0], -kFree, -l.speed[1], -kFree;
}

void Solver::guess(const Plan* warm) noexcept {
  const double g = tower_.design.crane.gravity_mps2;
  const double distance_m = std::abs(to_[0] - from_[0]) +
                            std::abs(to_[2] - from_[2]) * std::max(std::abs(from_[0]), std::abs(to_[0]));
  const double by_swing_s = 2.4 * std::sqrt(distance_m / (g * high_[1]));
  at_.duration_s = std::max(by_swing_s, 0.7 * plant::swing_period_s(g, tower_.cable_m));
  for (int k = 0; k <= kIntervals; ++k) {
    const double u = static_cast<double>(k) / kIntervals;
    const double share = u * u * (3 - 2 * u), speed = 6 * u * (1 - u) / at_.duration_s;
    State& s = at_.state[static_cast<std::size_t>(k)];
    s = from_ + share * (to_ - from_);
    s[4] = speed * (to_[0] - from_[0]);
    s[6] = speed * (to_[2] - from_[2]);
    if (k < kIntervals) at_.volts[static_cast<std::size_t>(k)].setZero();
  }
  if (warm != nullptr) {
    at_.duration_s = warm->duration_s;
    at_.state = warm->state;
    at_.volts = warm->volts;
  }
  constexpr double kInside = 0.02;  // share of the range that the first iterate keeps from its bounds
  for (std::size_t k = 0; k < kIntervals; ++k) {
    at_.volts[k] = at_.volts[k].cwiseMin((1 - kInside) * volt_limit_).cwiseMax((kInside - 1) * volt_limit_);
    if (k == 0) continue;
    const State margin = kInside * (high_ - low_);
    at_.state[k] = at_.state[k].cwiseMin(high_ - margin).cwiseMax(low_ + margin);
  }
  at_.state[0] = from_;
  centre_duals();
}

void Solver::centre_duals() noexcept {
  const auto central = [this](double value, double low, double high) -> Bounded {
    return {barrier_ / (value - low), barrier_ / (high - value)};
  };
  for (std::size_t k = 0; k < kIntervals; ++k) {
    for (int i = 0; i < kControls; ++i)
      volt_duals_[k][static_cast<std::size_t>(i)] = central(at_.volts[k][i], -volt_limit_[i], volt_limit_[i]);
    for (int i = 0; k > 0 && i < kStates; ++i)
      state_duals_[k][static_cast<std::size_t>(i)] = central(at_.state[k][i], low_[i], high_[i]);
  }
}

void Solver::linearise() noexcept {
  for (std::size_t k = 0; k < kIntervals; ++k) {
    step(tower_, at_.state[k], at_.volts[k], at_.duration_s / kIntervals, true, steps_[k]);
    gaps_[k] = steps_[k].next - at_.state[k + 1];
  }
}

Solver::Merit Solver::merit(const Iterate& at) const noexcept {
  Merit result;
  Step next;
  double sum = 0;
  for (std::size_t k = 0; k < kIntervals; ++k) {
    step(tower_, at.state[k], at.volts[k], at.duration_s / kIntervals, false, next);
    result.gaps += (next.next - at.state[k + 1]).lpNorm<1>();
    for (int i = 0; i < kControls; ++i) sum += logarithms(at.volts[k][i], -volt_limit_[i], volt_limit_[i]);
    for (int i = 0; k > 0 && i < kStates; ++i) sum += logarithms(at.state[k][i], low_[i], high_[i]);
    result.barrier += kEffort / (2 * kIntervals) * at.volts[k].cwiseQuotient(volt_limit_).squaredNorm();
  }
  result.gaps += (at.state[kIntervals] - to_).lpNorm<1>();
  result.barrier += at.duration_s - barrier_ * sum;
  return result;
}

void Solver::find_step() noexcept {
  Augmented cost = Augmented::Zero();
  AugmentedVector slope = AugmentedVector::Zero();
  const State miss = at_.state[kIntervals] - to_;
  cost.topLeftCorner<kStates, kStates>().diagonal().setConstant(1 / kEndSlack);
  slope.head<kStates>() = end_dual_ + miss / kEndSlack;
  for (std::size_t k = kIntervals; k-- > 0;) {
    Augmented a = Augmented::Identity();
    a.topLeftCorner<kStates, kStates>() = steps_[k].by_state;
    a.topRightCorner<kStates, 1>() = steps_[k].by_duration / kIntervals;
    const ControlMatrix& b = steps_[k].by_control;
    const AugmentedVector ahead = cost.leftCols<kStates>() * gaps_[k] + slope;
    const Augmented cost_a = cost * a;
    const Eigen::Matrix<double, kControls, kAugmented> cross = b.transpose() * cost_a.topRows<kStates>();
    Eigen::Matrix2d r = b.transpose() * cost.topLeftCorner<kStates, kStates>() * b;
    Control u = b.transpose() * ahead.head<kStates>();
    for (int i = 0; i < kControls; ++i) {
      const Barrier by = barrier_of(at_.volts[k][i], -volt_limit_[i], volt_limit_[i],
                                    volt_duals_[k][static_cast<std::size_t>(i)], barrier_);
      const double effort = kEffort / (kIntervals * volt_limit_[i] * volt_limit_[i]);
      r(i, i) += by.curvature + effort + kDamping;
      u[i] += by.gradient + effort * at_.volts[k][i];
    }
    const Eigen::Matrix2d inverse = r.inverse();
    feedback_[k] = inverse * cross;
    feed_forward_[k] = inverse * u;
    slope = (a.transpose() * ahead - cross.transpose() * feed_forward_[k]).eval();
    cost = (a.transpose() * cost_a - cross.transpose() * feedback_[k]).eval();
    cost = (0.5 * (cost + cost.transpose())).eval();
    for (int i = 0; k > 0 && i < kStates; ++i) {
      const Barrier by = barrier_of(at_.state[k][i], low_[i], high_[i],
                                    state_duals_[k][static_cast<std::size_t>(i)], barrier_);
      cost(i, i) += by.curvature;
      slope[i] += by.gradient;
    }
  }
  const double curvature = std::max(cost(kStates, kStates), 0.0) + 1e-6;
  change_.duration_s = fixed_ ? 0 : -(slope[kStates] + 1) / curvature;
  AugmentedVector z = AugmentedVector::Zero();
  z[kStates] = change_.duration_s;
  change_.state[0].setZero();
  for (std::size_t k = 0; k < kIntervals; ++k) {
    change_.volts[k] = -feedback_[k] * z - feed_forward_[k];
    z.head<kStates>() = (steps_[k].by_state * z.head<kStates>() + steps_[k].by_control * change_.volts[k] +
                         steps_[k].by_duration / kIntervals * change_.duration_s + gaps_[k])
                            .eval();
    change_.state[k + 1] = z.head<kStates>();
  }
}

double Solver::longest_step() const noexcept {
  double share = std::abs(change_.duration_s) > kMostChange * at_.duration_s
                     ? kMostChange * at_.duration_s / std::abs(change_.duration_s)
                     : 1;
  for (std::size_t k = 0; k < kIntervals; ++k) {
    for (int i = 0; i < kControls; ++i)
      share = std::min(share,
                       share_within(at_.volts[k][i], change_.volts[k][i], -volt_limit_[i], volt_limit_[i]));
    for (int i = 0; k > 0 && i < kStates; ++i)
      share = std::min(share, share_within(at_.state[k][i], change_.state[k][i], low_[i], high_[i]));
  }
  return share;
}

void Solver::update_duals(double share) noexcept {
  const auto both = [&](Bounded& dual, double value, double change, double low, double high) {
    move_dual(dual.low_dual, value - low, change, barrier_);
    move_dual(dual.high_dual, high - value, -change, barrier_);
  };
  for (std::size_t k = 0; k < kIntervals; ++k) {
    for (int i = 0; i < kControls; ++i)
      both(volt_duals_[k][static_cast<std::size_t>(i)], at_.volts[k][i], share * change_.volts[k][i],
           -volt_limit_[i], volt_limit_[i]);
    for (int i = 0; k > 0 && i < kStates; ++i)
      both(state_duals_[k][static_cast<std::size_t>(i)], at_.state[k][i], share * change_.state[k][i],
           low_[i], high_[i]);
  }
}

/// Halves the step until it closes the gaps or improves the objective.
bool Solver::take_step() noexcept {
  const Merit now = merit(at_);
  double share = longest_step();
  for (int i = 0; i < kMostHalvings; ++i, share /= 2) {
    trial_.duration_s = at_.duration_s + share * change_.duration_s;
    for (std::size_t k = 0; k < kIntervals; ++k) trial_.volts[k] = at_.volts[k] + share * change_.volts[k];
    for (std::size_t k = 0; k <= kIntervals; ++k) trial_.state[k] = at_.state[k] + share * change_.state[k];
    const Merit next = merit(trial_);
    const bool closes = next.gaps <= (1 - 0.1 * share) * now.gaps || next.gaps < kClosed;
    const bool improves =
        !fixed_ && next.barrier <= now.barrier - 1e-3 * now.gaps && next.gaps < 2 * now.gaps + kClosed;
    if (!std::isfinite(next.barrier) || !(closes || improves)) continue;
    update_duals(share);
    end_dual_ = ((1 - share) * end_dual_ +
                 share * (end_dual_ + (at_.state[kIntervals] + change_.state[kIntervals] - to_) / kEndSlack))
                    .eval();
    at_ = trial_;
    share_ = share;
    return true;
  }
  return false;
}

void Solver::fix_duration(double factor) noexcept {
  fixed_ = true;
  at_.duration_s *= factor;
  barrier_ = kRoomBarrier;
  end_dual_.setZero();
  centre_duals();
}

bool Solver::search(int& iterations) noexcept {
  fixed_ = false;
  for (int i = 0; i < kMostSearching; ++i) {
    ++iterations;
    linearise();
    find_step();
    if (!take_step()) return true;  // no step of this linearisation improves the iterate
    const bool near = std::abs(change_.duration_s) < kNearOptimum * at_.duration_s;
    const double gaps = merit(at_).gaps;
    if (!std::isfinite(gaps)) return false;
    if (barrier_ <= kEndBarrier && near && gaps < kNearGaps) return true;
    if (share_ > 0.3 && gaps < kNearGaps) barrier_ = std::max(kEndBarrier, kBarrierFactor * barrier_);
  }
  return true;
}

bool Solver::close_gaps(int& iterations) noexcept {
  for (int i = 0; i < kMostClosing; ++i) {
    ++iterations;
    linearise();
    find_step();
    if (!take_step()) return false;
    if (merit(at_).gaps < kClosed) return true;
  }
  return false;
}

PlanResult Solver::solve(const Plan* warm) noexcept {
  PlanResult result;
  barrier_ = warm != nullptr ? 10 * kEndBarrier : kStartBarrier;
  guess(warm);
  if (!search(result.iterations)) return result;
  fix_duration(kRoom);
  while (!close_gaps(result.iterations)) {
    if (result.iterations > kMostIterations) return result;
    fix_duration(kMoreRoom);
  }
  result.outcome = PlanOutcome::solved;
  result.plan = {at_.duration_s, at_.state, at_.volts};
  return result;
}

}  // namespace crane::control::time_optimal

namespace crane::control {

PlanResult time_optimal_plan(const Design& design, const PlanProblem& problem, const Plan* warm) noexcept {
  if (!problems(problem).empty()) {
    PlanResult refused;
    refused.outcome = PlanOutcome::impossible;
    return refused;
  }
  time_optimal::Solver solver(design, problem);
  return solver.solve(warm);
}

}  // namespace crane::control
