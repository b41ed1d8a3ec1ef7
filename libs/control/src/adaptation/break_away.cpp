#include "adaptation/break_away.hpp"

#include <algorithm>
#include <cmath>

namespace crane::control::adaptation {
namespace {

constexpr double kExcessShare = 0.15;  // initial standard deviation of the excess / break-away level
constexpr double kBreakAway_v = 0.04;  // standard deviation of one measured break-away
constexpr int kRest_ticks = 5;         // shortest time within the zero band before a break-away
constexpr int kMean_ticks = 3;         // duration of the mean that measures a break-away
constexpr double kCreepBands = 0.4;    // largest speed with the full break-away excess / zero band
// Scatter of a mean over kMean_ticks / scatter of a block of twice this duration: proportional to 1 /
// duration.
constexpr double kMeanScatter = 2;
constexpr double kCredible = 25;  // largest squared error / its variance: five standard deviations

constexpr double squared_excess_v(double value) noexcept { return value * value; }

}  // namespace

BreakAway::BreakAway(const DriveFriction& file, double share) noexcept
    : zero_band_{file.zero_band_mps},
      share_{share},
      file_static_v_{file.stiction_positive_v, file.stiction_negative_v} {
  const std::array coulomb_v{file.coulomb_positive_v, file.coulomb_negative_v};
  for (std::size_t d = 0; d < 2; ++d)
    excess_[d] = {std::max(0.0, file_static_v_[d] - coulomb_v[d]),
                  squared_excess_v(kExcessShare * file_static_v_[d])};
}

void BreakAway::rest(double friction_v, double speed) noexcept {
  const auto slot = static_cast<std::size_t>(rest_ticks_ % kHistory);
  resting_v_[slot] = friction_v;
  creeping_[slot] = speed <= kCreepBands * zero_band_;
  ++rest_ticks_;
}

bool BreakAway::rested() const noexcept { return rest_ticks_ >= kRest_ticks; }

/// Measures the break-away level: largest mean friction over kMean_ticks of creep, minus the scatter of this
/// mean.
bool BreakAway::learn(std::size_t direction, double coulomb_v, double scatter_v) noexcept {
  const int known = std::min(rest_ticks_, kHistory);
  const double side = direction == 0 ? 1 : -1;
  double largest = -1e9;
  for (int i = 0; i + kMean_ticks <= known; ++i) {
    double mean = 0;
    bool creeps = true;
    for (int j = 0; j < kMean_ticks; ++j) {
      const auto slot = static_cast<std::size_t>((rest_ticks_ - 1 - i - j) % kHistory);
      mean += side * resting_v_[slot] / kMean_ticks;
      creeps = creeps && creeping_[slot];
    }
    if (creeps) largest = std::max(largest, mean);
  }
  largest -= kMeanScatter * scatter_v;
  if (largest < (1 - share_) * file_static_v_[direction])
    return false;  // a fast step shows no break-away level
  Excess& excess = excess_[direction];
  const double error = largest - coulomb_v - excess.value_v;
  const double variance = excess.variance + squared_excess_v(kBreakAway_v);
  if (squared_excess_v(error) > kCredible * variance) return false;
  const double gain = excess.variance / variance;
  excess.value_v = std::max(0.0, excess.value_v + gain * error);
  excess.variance = std::max((1 - gain) * excess.variance, squared_excess_v(kBreakAway_v / 4));
  return true;
}

}  // namespace crane::control::adaptation
