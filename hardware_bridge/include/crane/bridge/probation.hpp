#pragma once
/// What a new writer of crane/command may ask for: nothing, for a while. A supervisor asks for nothing for
/// longer than that (self-test, then a reset that wants its causes clear for 1 s), so a real one never
/// notices. A program that reaches the bridge before the supervisor does, or after it died, and commands at
/// once, moves nothing; meanwhile discovery shows the second writer. Pure.
#include <cstdint>
#include <optional>

#include "crane/bridge/last_line.hpp"

namespace crane::bridge {

class Probation {
 public:
  /// Quiet time that a writer has to keep: half of the least that a supervisor keeps, and several times what
  /// discovery of a second process on the same host takes (0.05 to 0.15 s).
  static constexpr double kQuiet_s = 0.5;

  explicit Probation(double period_s) : quiet_ticks_{static_cast<std::uint64_t>(kQuiet_s / period_s)} {}

  /// `command` as far as its writer is believed: without volts, releases and permission until it has asked
  /// for none of them for kQuiet_s. @param new_writer  the first command of this writer
  [[nodiscard]] CommandView believed(const CommandView& command, bool new_writer) noexcept {
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
  std::optional<std::uint64_t>
      since_tick_;  ///< of the first command, or of the last one that asked too early
};

}  // namespace crane::bridge
