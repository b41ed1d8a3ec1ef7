#pragma once
/// Checks of a request before the state machine.
#include <optional>
#include <string>

#include "crane/supervisor/limits.hpp"
#include "crane/supervisor/modes.hpp"
#include "crane/supervisor/state_machine.hpp"
#include "crane/topics.hpp"

namespace crane::supervisor {

/// @return nothing for a kind that the supervisor does not process
[[nodiscard]] std::optional<Request> request_of(crane_RequestKind kind);
/// True for a move, for a reference to follow, and for a session of the stick.
[[nodiscard]] bool moves_axes(const msg::Request& request);
/// @return why axes, targets or sines of the request are not permitted; empty when they are permitted
[[nodiscard]] std::string problem_of(const msg::Request& request, const Limits& limits);
/// problem_of(), and problems that depend on the present `position`. For a reference to follow: a reference
/// of sines that starts far from `position` (Limits::largest_follow_jump), and a zone that contains the
/// target or lies in the straight path (in the coordinates of the axes) from `position` to the target. For a
/// move: a zone that contains the target, and no path around the zones.
[[nodiscard]] std::string problem_at(const msg::Request& request, const Limits& limits,
                                     const PerAxis& position);
/// @return why the operating mode does not permit the request at `position`; empty when it does
[[nodiscard]] std::string problem_in_mode(const msg::Request& request, Mode mode, const PerAxis& position);
/// @return why a request for an operating mode is refused in this state; empty when it is accepted. The mode
/// changes only while the brakes are closed.
[[nodiscard]] std::string mode_problem(const msg::Request& request, State state);
/// Axis of a homing request. @pre problem_of() is empty
[[nodiscard]] std::size_t home_axis_of(const msg::Request& request);

/// Requests of which only the first in each tick is executed. If there are a hundred zones, the search for
/// the path of one move takes up to 10 ms (docs/zones.md#figures), and several searches in one tick would
/// delay the command. Only one axis is homed at a time.
class OncePerTick {
 public:
  /// @return why the request is refused after the earlier requests of this tick; empty: it is the first such
  /// request
  [[nodiscard]] std::string problem_of(const msg::Request& request, const Limits& limits);

 private:
  bool searched_ = false, homed_ = false;
};

}  // namespace crane::supervisor
