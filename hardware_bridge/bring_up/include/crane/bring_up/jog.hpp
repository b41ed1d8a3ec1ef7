#pragma once
/// Small supervised motions of one drive: relay on, brake open, voltage, 0 V, brake closed, relay off.
#include <array>
#include <functional>

#include "crane/bring_up/session.hpp"

namespace crane::bring_up {

inline constexpr double kLargestJog_v = 5;
inline constexpr double kFarthestJog = 0.5;  ///< largest distance of a push, m or rad

struct JogPlan {
  std::size_t axis = 0;
  double drive_v = 0;                       ///< V; positive: outward, according to the sign in the rig file
  double distance = 0.05;                   ///< the push ends when any drive has moved this far, m or rad
  double duration_s = 1;                    ///< longest duration of the push
  double duration_without_motion_s = 0.12;  ///< longest duration of a push without a measured motion
  std::array<bool, kDrives> release{};      ///< brakes to open; normally that of the axis
  /// Called at every tick of the push; true ends the push.
  std::function<bool(const Sample&)> ends_when = [](const Sample&) { return false; };
};

/// @return problems of the plan as "name = value: rule"; empty when there are none
[[nodiscard]] std::vector<std::string> problems(const JogPlan& plan, const configuration::Rig& rig);

struct Jog {
  Record record;  ///< from the closed brake before the push to the closed brake after it
  std::array<double, kCounters> moved{};  ///< motion between the ends of the record, m or rad
  double drift = 0;                       ///< motion of the axis at 0 V with open brake, m or rad
  std::array<bool, kDrives> opened{};     ///< brakes whose contacts reported open
  bool closed_again = true;               ///< true: the brake closed within its closing time and two ticks
  bool limit = false;                     ///< true: a limit switch ended the push
};

/// Executes a plan. @pre problems(plan, rig).empty(). @throws Ended; the board is then safe
[[nodiscard]] Jog run(Session& session, const JogPlan& plan);

}  // namespace crane::bring_up
