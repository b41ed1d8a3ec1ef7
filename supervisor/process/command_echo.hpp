#pragma once
/// Whether the bridge does what this supervisor told it. A packet that carries the GUID of the supervisor's
/// writer is its own for everything above the middleware; but the bridge says with every state which voltage
/// acts and which command that was. Pure.
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "crane/topics.hpp"

namespace crane::supervisor {

class CommandEcho {
 public:
  /// A converter of 12 bits over 20 V gives steps of 5 mV; a rig's scale may be off by a percent of 10 V.
  static constexpr double kTolerance_v = 0.1;
  /// The supervisor's own commands that are remembered: more than a command may be old (stale_after_ticks).
  static constexpr std::size_t kRemembered = 64;
  /// States in a row. One is never enough to end a process.
  static constexpr int kStates = 2;
  /// A brake that is open for so long after the last release was closed by nobody, or opened by somebody
  /// else. Longer than the supervisor takes to name a brake that does not close (closing time and 0.11 s).
  static constexpr std::uint64_t kBrake_ticks = 50;

  /// @param present  axes that have a drive
  explicit CommandEcho(const std::array<bool, 3>& present) noexcept : present_{present} {}

  /// What was published for `command.header.tick`; a tick may be commanded more than once while no state
  /// comes.
  void commanded(const msg::Command& command) noexcept {
    auto& slot = commands_[command.header.tick % kRemembered];
    if (!first_tick_) first_tick_ = command.header.tick;
    if (slot.tick != command.header.tick || !slot.used) slot = {command.header.tick, true, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      slot.lowest_v[i] = std::fmin(slot.lowest_v[i], command.drive_v[i]);
      slot.highest_v[i] = std::fmax(slot.highest_v[i], command.drive_v[i]);
      if (command.brake_release[i]) released_tick_[i] = command.header.tick;
    }
  }
  /// A new bridge counts its ticks anew.
  void restart() noexcept { *this = CommandEcho{present_}; }

  /// @return true when the bridge obeys somebody else
  [[nodiscard]] bool contradicts(const msg::State& state) noexcept {
    volts_ = first_tick_ && unexplained_volts(state);
    in_a_row_ = first_tick_ && (volts_ || unexplained_brake(state)) ? in_a_row_ + 1 : 0;
    return in_a_row_ >= kStates;
  }
  /// Of the last contradiction: voltages; false: an open brake.
  [[nodiscard]] bool is_of_volts() const noexcept { return volts_; }

 private:
  /// 0 V needs no explanation: a latched bridge gives it whatever was commanded.
  struct Commanded {
    std::uint64_t tick = 0;
    bool used = false;
    std::array<double, 3> lowest_v{}, highest_v{};
  };
  [[nodiscard]] bool unexplained_volts(const msg::State& state) const noexcept {
    const auto tick = state.applied_command_tick;
    if (tick < *first_tick_) return false;  // of the supervisor before this one
    const auto& own = commands_[tick % kRemembered];
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
      if (state.header.tick > since + kBrake_ticks) return true;
    }
    return false;
  }

  std::array<bool, 3> present_;
  std::array<Commanded, kRemembered> commands_{};
  std::array<std::optional<std::uint64_t>, 3> released_tick_{};
  std::optional<std::uint64_t> first_tick_;
  int in_a_row_ = 0;
  bool volts_ = false;
};

}  // namespace crane::supervisor
