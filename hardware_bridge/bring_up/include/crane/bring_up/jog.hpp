#pragma once
/// Small guarded motions of one drive: relay on, brake open, volts, 0 V, brake closed, relay off.
#include <array>
#include <functional>

#include "crane/bring_up/session.hpp"

namespace crane::bring_up {

inline constexpr double kLargestJog_v = 5;
inline constexpr double kLongestJog = 0.5;  ///< m or rad

struct JogPlan {
  std::size_t axis = 0;
  double drive_v = 0;                   ///< positive: outward, by the rig file's sign
  double distance = 0.05;               ///< m or rad of any drive's counter: ends the push
  double duration_s = 1;                ///< ends the push, too
  double unseen_duration_s = 0.12;      ///< ends a push that no counter of a drive follows
  std::array<bool, kDrives> release{};  ///< brakes to open; the axis's own in a plain jog
  /// Looked at every tick of the push; true ends it.
  std::function<bool(const Sample&)> enough = [](const Sample&) { return false; };
};

/// Problems of the plan, one line each "name = value: rule"; empty when it may run.
[[nodiscard]] std::vector<std::string> problems(const JogPlan& plan, const configuration::Rig& rig);

struct Jog {
  Record record;                          ///< from the closed brake before to the closed brake after
  std::array<double, kCounters> moved{};  ///< between its ends, m or rad
  double drift = 0;                       ///< of the axis, at 0 V with open brake
  std::array<bool, kDrives> opened{};     ///< brakes whose contacts opened
  bool closed_again = true;               ///< the axis's brake, within its closing time and two ticks
  bool limit = false;                     ///< a limit switch ended it
};

/// The plan has no problems. @throws Ended; the board is safe then
[[nodiscard]] Jog run(Session& session, const JogPlan& plan);

}  // namespace crane::bring_up
