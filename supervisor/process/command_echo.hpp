#pragma once
/// Checks that the bridge executes the commands of this supervisor. Above the middleware, a forged packet
/// with the GUID of the supervisor's writer cannot be distinguished from a genuine one. Every state contains
/// the voltage that the bridge outputs and the tick of the command of this voltage. No I/O and no clock.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "crane/topics.hpp"
#include "process/ticks.hpp"

namespace crane::supervisor {

class CommandEcho {
 public:
  /// A 12-bit converter with a range of 20 V has steps of 5 mV; the scale of a rig may have an error of 1 %
  /// of 10 V.
  static constexpr double kTolerance_v = 0.1;
  /// Commands are stored for this time: twice the largest permitted age of a command (0.1 s, stale_after_s).
  static constexpr double kRemembered_s = 0.2;
  /// Number of consecutive contradicting states that end the supervisor.
  static constexpr int kContradictions = 2;
  /// Longest time from the last command to open a brake until the brake must be closed. A brake that is open
  /// after this time has failed to close, or another program has opened the brake. Longer than the
  /// detection time of a brake that does not close: at most 0.1 s (closing time) + 0.11 s (rule
  /// supervisor_brake_did_not_close).
  static constexpr double kBrake_s = 0.5;

  /// @param present   axes that have a drive
  /// @param period_s  duration of a tick, > 0
  CommandEcho(const std::array<bool, 3>& present, double period_s)
      : present_{present},
        brake_ticks_{ticks_in(kBrake_s, period_s)},
        commands_(ticks_in(kRemembered_s, period_s) + 1) {}

  /// Stores a published command by its tick. While no state arrives, the supervisor publishes several
  /// commands for the same tick.
  void commanded(const msg::Command& command) noexcept {
    auto& slot = commands_[command.header.tick % commands_.size()];
    if (!first_tick_) first_tick_ = command.header.tick;
    if (slot.tick != command.header.tick || !slot.used) slot = {command.header.tick, true, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      slot.lowest_v[i] = std::fmin(slot.lowest_v[i], command.drive_v[i]);
      slot.highest_v[i] = std::fmax(slot.highest_v[i], command.drive_v[i]);
      if (command.brake_release[i]) released_tick_[i] = command.header.tick;
    }
  }
  /// Call after a restart of the bridge, whose ticks start at 0.
  void restart() noexcept {
    std::ranges::fill(commands_, Commanded{});
    released_tick_ = {};
    first_tick_.reset();
    in_a_row_ = 0;
    volts_ = false;
  }

  /// @return true when kContradictions consecutive states show a voltage that this supervisor has not
  /// commanded, or a brake that is open without a command
  [[nodiscard]] bool contradicts(const msg::State& state) noexcept {
    volts_ = first_tick_ && unexplained_volts(state);
    in_a_row_ = first_tick_ && (volts_ || unexplained_brake(state)) ? in_a_row_ + 1 : 0;
    return in_a_row_ >= kContradictions;
  }
  /// Call after contradicts() has returned true. True: the last state showed a voltage that was not
  /// commanded; false: an open brake.
  [[nodiscard]] bool voltage_contradicts() const noexcept { return volts_; }

 private:
  /// Range of the commanded volts of one tick. It includes 0 V, which a latched bridge always outputs.
  struct Commanded {
    std::uint64_t tick = 0;
    bool used = false;
    std::array<double, 3> lowest_v{}, highest_v{};
  };
  [[nodiscard]] bool unexplained_volts(const msg::State& state) const noexcept {
    const auto tick = state.applied_command_tick;
    if (tick < *first_tick_) return false;  // command of an earlier supervisor
    const auto& own = commands_[tick % commands_.size()];
    for (std::size_t i = 0; i < 3; ++i) {
      const double v = state.applied_v[i];
      if (!present_[i] || std::abs(v) <= kTolerance_v) continue;
      if (!own.used || own.tick != tick) return true;
      if (v < own.lowest_v[i] - kTolerance_v || v > own.highest_v[i] + kTolerance_v) return true;
    }
    return false;
  }
  [[nodiscard]] bool unexplained_brake(const msg::State& state) const noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!present_[i] || state.brake_closed[i]) continue;
      const auto since = released_tick_[i].value_or(*first_tick_);
      if (state.header.tick > since + brake_ticks_) return true;
    }
    return false;
  }

  std::array<bool, 3> present_;
  std::uint64_t brake_ticks_;
  std::vector<Commanded> commands_;  ///< by tick modulo size
  std::array<std::optional<std::uint64_t>, 3> released_tick_{};
  std::optional<std::uint64_t> first_tick_;
  int in_a_row_ = 0;
  bool volts_ = false;
};

}  // namespace crane::supervisor
