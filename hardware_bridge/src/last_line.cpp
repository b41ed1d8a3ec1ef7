#include "crane/bridge/last_line.hpp"

#include <cmath>

namespace crane::bridge {

bool LastLine::acceptable(const CommandView& command) const noexcept {
  constexpr double kRounding = 1e-9;
  for (std::size_t i = 0; i < kDrives; ++i)
    if (!(std::abs(command.drive_v[i]) <= parameters_.volt_limit_v[i] + kRounding))
      return false;  // NaN fails
  return true;
}

void LastLine::reset_on_permission_edge(const CommandView& command) noexcept {
  const bool quiet = !command.brake_release[0] && !command.brake_release[1] && !command.brake_release[2] &&
                     command.drive_v == std::array<double, kDrives>{};
  if (!quiet) return;
  if (!command.watchdog_permission) {
    permission_withheld_ = true;
  } else if (permission_withheld_) {
    stale_ = invalid_ = permission_withheld_ = false;
  }
}

Outputs LastLine::decide(const std::optional<CommandView>& command, std::uint64_t tick) noexcept {
  if (!command) return {};
  const bool fresh = command->tick < tick && tick - 1 - command->tick < parameters_.stale_after_ticks;
  if (fresh && (stale_ || invalid_)) reset_on_permission_edge(*command);
  if (!fresh) stale_ = true;
  if (!acceptable(*command)) invalid_ = true;
  if (stale_ || invalid_) return {};
  watchdog_level_ = command->watchdog_permission && !watchdog_level_;
  return {.drive_v = command->drive_v,
          .brake_release = command->brake_release,
          .watchdog_level = watchdog_level_};
}

}  // namespace crane::bridge
