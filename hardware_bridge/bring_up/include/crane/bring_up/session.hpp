#pragma once
/// Direct access to a board for the bring-up of a rig: tick by tick, without the stack. Every end of a
/// session, also by an exception or Ctrl-C, leaves the board at 0 V with closed brakes.
#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "crane/bridge/board.hpp"
#include "crane/bridge/measurement.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bring_up {

using bridge::kCounters;
using bridge::kDrives;

/// "trolley", "slew", "hoist", "swing_radial", "swing_tangential". The first three have drives.
[[nodiscard]] std::string_view coordinate_name(std::size_t coordinate);
[[nodiscard]] std::string_view coordinate_unit(std::size_t coordinate);  ///< "m" or "rad"

/// Inputs of the board at the end of a tick.
struct Sample {
  double time_s = 0;                             ///< since the start of the session
  std::array<std::int64_t, kCounters> counts{};  ///< unwrapped
  std::array<double, kCounters> coordinate{};    ///< m or rad, with signs and scales of the rig file
  bridge::Inputs inputs{};
};
using Record = std::vector<Sample>;

/// The session has ended: because of Ctrl-C, the emergency stop or a suspension of this program.
/// what() is the reason.
class Ended : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Functions that wait for a tick, report an interruption, and read a clock.
struct Clock {
  std::function<void(std::int64_t duration_ns)> wait = [](std::int64_t) {
  };  ///< default for simulated time: no wait
  std::function<bool()> interrupted = [] { return false; };
  std::function<std::int64_t()> now_ns = [] { return 0; };  ///< default: no tick is ever late
};

class Session {
 public:
  /// `rig` and `board` must outlive the session.
  Session(const configuration::Rig& rig, bridge::Board& board, Clock clock);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Runs one tick at 0 V with closed brakes, without toggling the watchdog output. @throws Ended
  const Sample& tick_braked();
  /// Runs one tick and toggles the watchdog output. The relay opens and the brakes close when this program is
  /// suspended for longer than relay_timeout_s of the rig file. The session then ends, because the next
  /// toggle would release the brakes again.
  /// @throws Ended, also when the relay has opened, or the tick lasted longer than relay_timeout_s
  ///   and two periods
  /// @param drive_v  V; the session applies the sign of the drive in the rig file: a positive voltage moves
  ///   the axis outwards
  const Sample& tick_driven(const std::array<double, kDrives>& drive_v,
                            const std::array<bool, kDrives>& release);

  /// Calls tick_braked() for at least `duration_s`.
  Record record_braked(double duration_s);
  /// Toggles the watchdog output with closed brakes for 0.2 s, in which the relay closes.
  void close_relay();

  [[nodiscard]] const Sample& sample() const { return sample_; }
  [[nodiscard]] const configuration::Rig& rig() const { return rig_; }
  void make_safe() noexcept { board_.make_safe(); }

 private:
  const Sample& tick(const bridge::Outputs& outputs);
  [[noreturn]] void end(const std::string& why);
  void take(const bridge::Inputs& inputs);

  const configuration::Rig& rig_;
  bridge::Board& board_;
  Clock clock_;
  std::int64_t period_ns_;
  std::int64_t time_ns_ = 0;
  bool level_ = false;
  bool relay_closed_ = false;  ///< in the previous driven tick; false after a braked tick
  std::array<bridge::CountUnwrapper, kCounters> unwrapper_;
  Sample sample_;
};

}  // namespace crane::bring_up
