#include "crane/bridge/homing.hpp"

#include <algorithm>
#include <cmath>

namespace crane::bridge {

bool mark_active(const configuration::Drive& drive, const Inputs& inputs, std::size_t axis) noexcept {
  if (!drive.homes()) return false;
  switch (drive.homing.mark) {
    case control::Mark::limit_low:
      return inputs.limit_low[axis];
    case control::Mark::limit_high:
      return inputs.limit_high[axis];
    case control::Mark::input:
      return inputs.mark[axis];
  }
  return false;
}

Homing::Homing(const configuration::Rig& rig) {
  constexpr double kFaster = 2, kLeastBack = 0.5, kTicks = 2;
  for (std::size_t i = 0; i < kDrives; ++i) {
    const auto& drive = rig.drives[i];
    if (!drive.homes()) continue;
    const auto& homing = drive.homing;
    const double counts = rig.encoders[i].counts_per_unit;
    Axis& axis = axes_[i];
    axis.homes = true;
    axis.known = false;
    axis.towards = homing.direction() * rig.encoders[i].sign;
    axis.mark_counts = rig.encoders[i].sign * homing.position * counts;
    axis.approach_counts = std::max(kFaster * homing.approach_speed * rig.period_s * counts, 2.0);
    axis.agreement_counts =
        kTicks * homing.speed * rig.period_s * counts + kLeastBack * homing.back_off * counts;
    axis.back_off_counts = kLeastBack * homing.back_off * counts;
  }
}

void Homing::forget(std::size_t i) noexcept {
  Axis& axis = axes_[i];
  if (!axis.homes) return;
  axis.known = false;
  axis.first.reset();
  axis.found.reset();
}

std::optional<std::int64_t> Homing::step(std::size_t i, const MarkView& view) noexcept {
  Axis& axis = axes_[i];
  if (!axis.homes) return std::nullopt;
  if (view.requested && !axis.was_requested) forget(i);
  if (!view.requested && !axis.known) forget(i);  // homing has failed or was stopped
  if (view.requested && view.free && axis.started) look(axis, view);
  axis.was_requested = view.requested;
  axis.was_active = view.active;
  axis.last_counts = view.counts;
  axis.started = true;
  if (!view.requested || !axis.found || view.active || !view.rests) return std::nullopt;
  const auto shift = std::llround(axis.mark_counts - *axis.found);
  axis.first.reset();
  axis.found.reset();
  axis.known = true;
  axis.last_counts += shift;
  return shift;
}

/// Detects the mark. Its position is the mean of the two readings between which the switch changes.
void Homing::look(Axis& axis, const MarkView& view) noexcept {
  const auto change = static_cast<double>(view.counts - axis.last_counts);
  const double at = static_cast<double>(axis.last_counts) + change / 2;
  if (axis.first && !view.active)
    axis.farthest_counts = std::max(axis.farthest_counts, -axis.towards * (at - *axis.first));
  const bool closes = view.active && !axis.was_active && change * axis.towards >= 0;
  if (!closes || axis.found) return;
  const bool been_back = axis.first && axis.farthest_counts >= axis.back_off_counts;
  if (axis.first && !been_back) return;  // contact bounce
  const bool slow = std::abs(change) <= axis.approach_counts;
  if (been_back && slow && std::abs(at - *axis.first) <= axis.agreement_counts) {
    axis.found = at;
    return;
  }
  axis.first = at;
  axis.farthest_counts = 0;
}

}  // namespace crane::bridge
