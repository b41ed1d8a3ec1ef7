#pragma once
/// What a rig is to the bridge: counters, analog and digital lines, a watchdog output, and time.
/// The simulated plant is one board, an encoder/DAC card another; the bridge's loop is the same for both.
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string_view>

namespace crane::bridge {

inline constexpr std::size_t kCounters = 5;  ///< trolley, slew, hoist, radial swing, tangential swing
inline constexpr std::size_t kDrives = 3;    ///< trolley, slew, hoist

/// Latched together at one instant.
struct Inputs {
  std::array<std::int32_t, kCounters> raw_counts{};  ///< 24-bit two's complement, sign-extended; wraps
  std::array<bool, kDrives> limit_low{}, limit_high{};
  std::array<bool, kDrives>
      mark{};  ///< the axis is below the mark that it is homed by, where it has one of its own
  std::array<bool, kDrives> brake_closed{};
  bool estop_pressed = false;
  bool watchdog_dropped = false;  ///< the relay has removed the brake supply
};

/// Written together, once a tick.
struct Outputs {
  std::array<double, kDrives> drive_v{};  ///< V, within +-10; the board quantises and clamps
  std::array<bool, kDrives> brake_release{};
  bool watchdog_level = false;  ///< charge pump: has to toggle every tick to keep the brakes supplied
};

/// A board that is not there, not permitted, in use or defective; what() is one line with the remedy.
class BoardError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Board {
 public:
  virtual ~Board() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Latches all counters and inputs at this instant. @throws BoardError when the board does not answer
  [[nodiscard]] virtual Inputs read() = 0;
  /// @return the voltages that the converters give (quantised, clamped). @throws BoardError when the board
  /// does not answer
  virtual std::array<double, kDrives> write(const Outputs& outputs) = 0;
  /// 0 V, brakes without supply, watchdog output at rest. Must always be safe to call.
  virtual void make_safe() noexcept = 0;
  /// Lets the rig's own time run on to `time_ns` (simulated boards; a no-op where nature does it).
  virtual void advance_to(std::int64_t time_ns) = 0;
  /// Time passes on this board only in advance_to(): it can run in lockstep. A rig in nature cannot wait.
  [[nodiscard]] virtual bool simulates_time() const { return false; }
  /// Adds to the swing rates at this instant: a push against the load. @return false where nature does the
  /// pushing
  virtual bool kick(double /*radial_radps*/, double /*tangential_radps*/) { return false; }
};

}  // namespace crane::bridge
