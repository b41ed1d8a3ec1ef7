#pragma once
/// A board in the hands of somebody who brings a rig up: tick by tick, without the stack. Whatever ends a
/// session (its end, an exception, Ctrl-C), the board is at 0 V with closed brakes then.
#include <array>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "crane/bridge/board.hpp"
#include "crane/bridge/measurement.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bring_up {

using bridge::kCounters;
using bridge::kDrives;

/// "trolley", "slew", "hoist", "swing_radial", "swing_tangential": drives have the first three.
[[nodiscard]] std::string_view coordinate_name(std::size_t coordinate);
[[nodiscard]] std::string_view coordinate_unit(std::size_t coordinate);  ///< "m" or "rad"

/// What the board showed at the end of a tick.
struct Sample {
  double time_s = 0;
  std::array<std::int64_t, kCounters> counts{};  ///< unwrapped
  std::array<double, kCounters> coordinate{};    ///< m or rad, as the rig file has signs and scales
  bridge::Inputs inputs{};
};
using Record = std::vector<Sample>;

/// The session has been ended by somebody: Ctrl-C or the emergency stop.
class Ended : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Time outside of the board.
struct Clock {
  std::function<void(std::int64_t duration_ns)> wait = [](std::int64_t) {};  ///< nothing for simulated time
  std::function<bool()> interrupted = [] { return false; };
};

class Session {
 public:
  /// Both outlive the session.
  Session(const configuration::Rig& rig, bridge::Board& board, Clock clock);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// One tick at 0 V with closed brakes and a watchdog output at rest. @throws Ended
  const Sample& rest();
  /// One tick with the watchdog output toggling. `drive_v` are volts with the drive's sign of the rig file
  /// taken into account: positive should move outward. @throws Ended
  const Sample& awake(const std::array<double, kDrives>& drive_v, const std::array<bool, kDrives>& release);

  /// Ticks of `rest` that last at least `duration_s`.
  Record watch(double duration_s);
  /// Toggles for long enough that the watchdog relay closes, brakes closed.
  void wake();

  [[nodiscard]] const Sample& sample() const { return sample_; }
  [[nodiscard]] const configuration::Rig& rig() const { return rig_; }
  void make_safe() noexcept { board_.make_safe(); }

 private:
  const Sample& tick(const bridge::Outputs& outputs);
  void take(const bridge::Inputs& inputs);

  const configuration::Rig& rig_;
  bridge::Board& board_;
  Clock clock_;
  std::int64_t period_ns_;
  std::int64_t time_ns_ = 0;
  bool level_ = false;
  std::array<bridge::CountUnwrapper, kCounters> unwrapper_;
  Sample sample_;
};

}  // namespace crane::bring_up
