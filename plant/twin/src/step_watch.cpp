#include "crane/twin/step_watch.hpp"

#include <algorithm>
#include <cmath>

namespace crane::twin {
namespace {

constexpr double kMargin = 3;       // smallest step / largest change while learning
constexpr double kExplained = 0.9;  // smallest share of the energy of the residual that the shape explains
constexpr double kBetter = 0.5;     // largest unexplained energy / that of the shape of a constant force
constexpr std::size_t kApart_ticks = 5;  // second distance of two residuals: for steps over several ticks

}  // namespace

StepWatch::StepWatch(double period_s, double horizon_s, double least_jump)
    : period_s_(period_s), least_jump_(least_jump) {
  const double rho = std::exp(-period_s / horizon_s);
  const auto shape = [&](double position, double rate, double acceleration,
                         std::array<double, kHistory>& out) {
    for (double& e : out) {
      e = position;
      position -= (1 - rho * rho) * e;
      rate -= (1 - rho) * (1 - rho) / period_s * e;
      position += period_s * (rate + 0.5 * period_s * acceleration);
      rate += period_s * acceleration;
    }
  };
  shape(1, 0, 0, slip_shape_);
  shape(period_s, 1, 0, push_shape_);
  shape(0.5 * period_s * period_s, period_s, 1, force_shape_);
}

void StepWatch::restart() {
  newest_ = filled_ = 0;
  until_decision_ = 0;
}

std::optional<Step> StepWatch::add(double residual, bool learning) {
  newest_ = (newest_ + 1) % kHistory;
  history_[newest_] = residual;
  if (filled_ < kHistory) {
    ++filled_;
    return std::nullopt;
  }
  const double jump_1 = std::abs(at(0) - at(1)), jump_5 = std::abs(at(0) - at(kApart_ticks));
  if (learning) {
    largest_1_ = std::max(largest_1_, jump_1);
    largest_5_ = std::max(largest_5_, jump_5);
    return std::nullopt;
  }
  if (until_decision_ > 0) return --until_decision_ == 0 ? classify() : std::nullopt;
  if (jump_1 > kMargin * largest_1_ + least_jump_ || jump_5 > kMargin * largest_5_ + least_jump_)
    until_decision_ = kShape_ticks - 1;
  return std::nullopt;
}

std::optional<Step> StepWatch::classify() const {
  Step best;
  double explained = 0, by_force = 0;
  for (std::size_t first = kShape_ticks - 1; first + 1 < kHistory; ++first) {  // ticks since the step
    const double before = at(first + 1);
    const auto share_of = [&](const std::array<double, kHistory>& shape, double& size) {
      double energy = 0, product = 0, norm = 0;
      for (std::size_t back = 0; back <= kHistory - 2; ++back) {
        const double e = at(back) - before, s = back <= first ? shape[first - back] : 0;
        energy += e * e, product += e * s, norm += s * s;
      }
      size = product / norm;
      return energy > 0 ? product * product / norm / energy : 0;
    };
    double size = 0;
    by_force = std::max(by_force, share_of(force_shape_, size));
    for (const StepKind kind : {StepKind::slip, StepKind::push}) {
      const double share = share_of(kind == StepKind::slip ? slip_shape_ : push_shape_, size);
      if (share <= explained) continue;
      explained = share;
      best = {kind, size};
    }
  }
  if (explained < kExplained || 1 - explained > kBetter * (1 - by_force)) return std::nullopt;
  return best;
}

}  // namespace crane::twin
