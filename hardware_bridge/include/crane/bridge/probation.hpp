#pragma once
/// Quiet time of a new writer of crane/command. The bridge executes the commands of a new writer only after
/// the writer has sent quiet commands for kQuiet_s: 0 V, closed brakes, no homing, no watchdog permission. A
/// supervisor sends quiet commands for longer (self-test, then 1 s without a cause before a reset). A program
/// that commands motion at once moves nothing, even when no supervisor runs. Discovery reports a
/// second writer within the quiet time. No I/O and no clock.
#include <cstdint>
#include <optional>

#include "crane/bridge/last_line.hpp"

namespace crane::bridge {

class Probation {
 public:
  /// Half of the shortest quiet time of a supervisor, and at least three times the duration of the discovery
  /// of a second process on the same host (0.05 to 0.15 s).
  static constexpr double kQuiet_s = 0.5;

  explicit Probation(double period_s) : quiet_ticks_{static_cast<std::uint64_t>(kQuiet_s / period_s)} {}

  /// @return `command`; during the quiet time of its writer: a command with 0 V, closed brakes, without
  ///   homing and permission. @param new_writer  true: the first command of this writer
  [[nodiscard]] CommandView accepted(const CommandView& command, bool new_writer) noexcept {
    if (new_writer) since_tick_.reset();
    const bool asks = command.watchdog_permission || command.drive_v != CommandView{}.drive_v ||
                      command.brake_release != CommandView{}.brake_release ||
                      command.homing != CommandView{}.homing;
    const bool served = since_tick_ && command.tick - *since_tick_ >= quiet_ticks_;
    if (!since_tick_ || (asks && !served)) since_tick_ = command.tick;
    return served || !asks ? command : CommandView{.tick = command.tick};
  }

 private:
  std::uint64_t quiet_ticks_;
  std::optional<std::uint64_t> since_tick_;  ///< start of the quiet time: tick of the first command, or of
                                             ///< the last command that was not quiet
};

}  // namespace crane::bridge
