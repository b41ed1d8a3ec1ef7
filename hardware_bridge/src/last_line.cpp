#include "crane/bridge/last_line.hpp"

#include <algorithm>
#include <cmath>

#include "crane/protection.hpp"

namespace crane::bridge {
namespace {

using protection::enabled;
using enum protection::Protection;

/// Protections of the mutation check, in the order of Reason from command_stale on.
constexpr std::array kProtections{bridge_command_stale, bridge_command_not_finite, bridge_command_range,
                                  bridge_command_rate,  bridge_position,           bridge_speed,
                                  bridge_swing,         bridge_encoder_jump,       bridge_lost_counts,
                                  bridge_braked_motion, bridge_encoder_frozen,     bridge_drive_response,
                                  bridge_not_homed,     bridge_second_writer};
static_assert(kProtections.size() + 1 == kReasons);

bool is_enabled(const Check& check) noexcept {
  return enabled(kProtections[static_cast<std::size_t>(check.reason) - 1]);
}

}  // namespace

void History::add(const Entry& entry) noexcept {
  newest_ = (newest_ + 1) % kLength;
  entries_[newest_] = entry;
  size_ = std::min(size_ + 1, kLength);
}

Outputs LastLine::decide(const std::optional<CommandView>& command, std::uint64_t tick,
                         const Observation& observation) noexcept {
  observe(tick, observation);
  if (!enabled(bridge_latch_is_kept)) reason_ = Reason::none;
  if (command && reason_ != Reason::none && !final_) reset_on_permission_edge(*command);
  const CheckInput input{tick, command ? &*command : nullptr, before_, &history_, braked_at_};
  if (reason_ == Reason::none) latch(first_failure(input), input);
  if (reason_ != Reason::none || !command) {
    before_ = {};
    return executed_ = {};
  }
  before_ = *command;
  executed_ = {.drive_v = command->drive_v,
               .brake_release = command->brake_release,
               .watchdog_level = command->watchdog_permission && !executed_.watchdog_level};
  return executed_;
}

void LastLine::observe(std::uint64_t tick, const Observation& observation) noexcept {
  History::Entry entry{tick, observation, executed_.brake_release, {}};
  for (std::size_t i = 0; i < kDrives; ++i) {
    entry.free[i] = executed_.brake_release[i] && !observation.brake_closed[i];
    if (parameters_.axis[i].present) follow_brake(i, tick, observation);
  }
  history_.add(entry);
}

/// Stores the coordinate at which the closed brake has stopped the axis. From then on the axis must stay
/// there.
void LastLine::follow_brake(std::size_t axis, std::uint64_t tick, const Observation& observation) noexcept {
  if (executed_.brake_release[axis]) {
    commanded_closed_[axis] = false;
    braked_at_[axis].reset();
    return;
  }
  if (!commanded_closed_[axis]) {
    const AxisCheckParameters& line = parameters_.axis[axis];
    constexpr double kReserve = 1.5, kReserve_s = 0.05;
    const double moved =
        history_.size() > 0 ? observation.coordinate[axis] - history_[0].observation.coordinate[axis] : 0;
    const double speed = std::min(std::abs(moved) / parameters_.period_s, line.max_speed);
    const double rest_s = line.brake_close_time_s + kReserve * speed / line.brake_deceleration + kReserve_s;
    commanded_closed_[axis] = true;
    rests_from_tick_[axis] = tick + static_cast<std::uint64_t>(std::ceil(rest_s / parameters_.period_s));
  }
  if (!braked_at_[axis] && tick >= rests_from_tick_[axis]) braked_at_[axis] = observation.coordinate[axis];
}

Reason LastLine::first_failure(const CheckInput& input) const noexcept {
  const auto failed = std::find_if(checks_.begin(), checks_.end(), [&](const Check& check) {
    return is_enabled(check) && check.fails(parameters_, input);
  });
  return failed == checks_.end() ? Reason::none : failed->reason;
}

/// Latches `reason`. The latch is not final when all doubtful counters belong to axes with a homing mark.
void LastLine::latch(Reason reason, const CheckInput& input) noexcept {
  reason_ = reason;
  if (reason == Reason::none) return;
  final_ = is_final(reason);
  doubted_ = {};
  const auto counters = counters_in_doubt(reason, parameters_, input);
  bool any = false, all_home = true;
  for (std::size_t i = 0; i < kCounters; ++i) {
    if (!counters[i]) continue;
    any = true;
    all_home = all_home && i < kDrives && parameters_.axis[i].homes();
    if (i < kDrives) doubted_[i] = true;
  }
  if (any && all_home) final_ = false;
}

void LastLine::shift(std::size_t axis, double change) noexcept {
  history_.shift(axis, change);
  if (braked_at_[axis]) *braked_at_[axis] += change;
}

void LastLine::reset_on_permission_edge(const CommandView& command) noexcept {
  const bool fresh =
      history_[0].tick > command.tick && history_[0].tick - 1 - command.tick < parameters_.stale_after_ticks;
  const bool quiet = command.brake_release == std::array<bool, kDrives>{} &&
                     command.drive_v == std::array<double, kDrives>{};
  if (!fresh || !quiet) return;
  if (!command.watchdog_permission) {
    permission_withheld_ = true;
  } else if (permission_withheld_ && !history_[0].observation.second_writer) {
    permission_withheld_ = false;
    reason_ = Reason::none;
    doubted_ = {};
  }
}

}  // namespace crane::bridge
