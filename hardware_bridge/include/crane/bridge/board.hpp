#pragma once
/// Interface between the bridge and a rig: counters, analog and digital lines, a watchdog output, and time.
/// The simulated plant and the drivers of the boards implement this interface; the bridge has the same loop
/// for every board.
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string_view>

namespace crane::bridge {

inline constexpr std::size_t kCounters = 5;  ///< trolley, slew, hoist, radial swing, tangential swing
inline constexpr std::size_t kDrives = 3;    ///< trolley, slew, hoist

/// Inputs of one instant.
struct Inputs {
  std::array<std::int32_t, kCounters> raw_counts{};     ///< 24-bit two's complement, sign-extended; wraps
  std::array<bool, kDrives> limit_low{}, limit_high{};  ///< true: the limit switch of the axis is pressed
  std::array<bool, kDrives> mark{};          ///< Mark::input; true: the axis is at or below its homing mark
  std::array<bool, kDrives> brake_closed{};  ///< true: the contact of the brake reports closed
  bool estop_pressed = false;                ///< true: the emergency stop is pressed
  bool watchdog_dropped = false;             ///< true: the relay has removed the brake supply
};

/// Outputs of one tick.
struct Outputs {
  std::array<double, kDrives> drive_v{};      ///< V, in [-10, 10]; the board quantises and limits the values
  std::array<bool, kDrives> brake_release{};  ///< true: supply the brake, which opens it
  /// Level of the watchdog output (charge pump): must toggle every tick to keep the brakes supplied.
  bool watchdog_level = false;
};

/// The board is missing, not permitted, in use or defective. what() is one line with the remedy.
class BoardError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Board {
 public:
  virtual ~Board() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Latches all counters and inputs. @throws BoardError when the board does not answer
  [[nodiscard]] virtual Inputs read() = 0;
  /// Sets all outputs. @return the output voltages of the converters (quantised, limited). @throws BoardError
  /// when the board does not answer
  virtual std::array<double, kDrives> write(const Outputs& outputs) = 0;
  /// Sets 0 V, removes the supply of the brakes and stops toggling the watchdog output. May be called at any
  /// time.
  virtual void make_safe() noexcept = 0;
  /// Simulated boards: advances the rig up to `time_ns`, the time since the start (in lockstep: tick times
  /// period). Other boards: no effect.
  virtual void advance_to(std::int64_t time_ns) = 0;
  /// True when time passes only in advance_to(), so that the board can run in lockstep.
  [[nodiscard]] virtual bool simulates_time() const { return false; }
  /// Simulated boards: adds swing rates (a push of the load). @return false when the board cannot do this
  virtual bool kick(double /*radial_radps*/, double /*tangential_radps*/) { return false; }
};

}  // namespace crane::bridge
