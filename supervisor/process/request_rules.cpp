#include "process/request_rules.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "crane/fields/shortest.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/protection.hpp"
#include "crane/runtime/convert.hpp"
#include "crane/supervisor/zone_filter.hpp"

namespace crane::supervisor {
namespace {

using fields::shortest;
using protection::enabled;
using enum protection::Protection;

constexpr double kLongestFollow_s = 3600;

/// Upper bounds of distance and speed of a request's sum of sines.
struct Excursion {
  double distance = 0, speed = 0;
};
Excursion excursion_of(const msg::Request& request) {
  Excursion sum;
  if (request.kind != crane_REQUEST_FOLLOW) return sum;
  for (const auto& sine : request.sine) {
    sum.distance += std::abs(sine.amplitude);
    sum.speed += std::abs(sine.amplitude * 2 * std::numbers::pi * sine.frequency_hz);
  }
  return sum;
}

std::string target_problem(const msg::Request& request, const AxisLimits& axis, std::size_t i) {
  const auto excursion = excursion_of(request);
  const double wanted = runtime::values(request.target)[i];
  for (const double target : {wanted - excursion.distance, wanted + excursion.distance})
    if (!target_allowed(axis, target) && enabled(request_target))
      return std::string{plant::kCoordinates[i].name} + " target " + shortest(target) + " must lie in [" +
             shortest(axis.low_limit + axis.soft_margin) + ", " +
             shortest(axis.high_limit - axis.soft_margin) + "]";
  if (excursion.speed <= axis.max_speed) return "";
  return std::string{"the sines need a "} + plant::kCoordinates[i].name + " speed of " +
         shortest(excursion.speed) + ", above max_speed " + shortest(axis.max_speed);
}

/// A sine above half the tick rate cannot be represented by the reference: it would jump from tick to tick.
std::string follow_problem(const msg::Request& request, const Limits& limits) {
  const double highest_hz = 0.5 / limits.period_s;
  if (!std::ranges::all_of(request.sine,
                           [&](const auto& sine) { return std::abs(sine.frequency_hz) <= highest_hz; }))
    return "follow: frequency_hz must lie in [0, " + shortest(highest_hz) + "], half the tick rate";
  if (!std::ranges::all_of(request.sine, [](const auto& sine) { return std::isfinite(sine.phase_rad); }))
    return "follow: phase_rad must be finite";
  const bool lasts = request.duration_s >= 0 && request.duration_s <= kLongestFollow_s;
  return lasts ? "" : "follow: duration_s must lie in [0, 3600]";
}

/// A reference of sines that starts far from its axis is a jump, to which the controllers respond with full
/// voltage. Without sines the reference is a step; its response is the purpose of the request.
std::string begin_problem(const msg::Request& request, const Limits& limits, const PerAxis& position) {
  if (excursion_of(request).distance == 0) return "";
  const PerAxis target = runtime::values(request.target);
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double distance = std::abs(target[i] - position[i]);
    if (!request.selected[i] || distance <= limits.largest_follow_jump[i]) continue;
    const std::string unit = i == 1 ? " rad" : " m";
    return "follow: the reference begins " + shortest(distance) + unit + " from the " +
           plant::kCoordinates[i].name + " position (at most " + shortest(limits.largest_follow_jump[i]) +
           unit + "): move the axis to the start of the reference first";
  }
  return "";
}

constexpr const char* kHint = " (zones include the radius of the load; `crane zone list` shows them)";

/// The planner follows sines only on the straight path, not around zones.
std::string zone_problem(const Limits& limits, const PerAxis& from, const PerAxis& to) {
  const auto* zone = control::zone_in_path(limits.zones, limits.clearance, limits.machine.crane.gravity_mps2,
                                           from, to, control::kRestClearance_m);
  if (zone == nullptr) return "";
  const bool inside = control::closest_zone(limits.path_space, to).clearance_m < control::kRestClearance_m;
  return std::string{inside ? "the target is inside zone "
                            : "the straight path to the target leads through zone "} +
         zone->name + kHint + (inside ? "" : ": move around the zone first");
}

std::string path_problem(const Limits& limits, const control::Path& path) {
  constexpr std::size_t kNamed = 4;
  if (path.outcome == control::PathOutcome::straight || path.outcome == control::PathOutcome::by_waypoints)
    return "";
  std::string names;
  for (std::size_t i = 0; i < std::min(kNamed, path.blocking.size()); ++i)
    names += (i == 0 ? "" : ", ") + limits.zones.at(path.blocking[i]).name;
  if (path.blocking.size() > kNamed)
    names += " and " + std::to_string(path.blocking.size() - kNamed) + " more";
  if (path.outcome == control::PathOutcome::target_inside)
    return "the target is inside zone " + names + kHint;
  if (names.empty())
    return "no path leads to the target: the measured position is not finite or far outside the limits";
  return "no path leads to the target past " + (path.blocking.size() == 1 ? "zone " : std::string{"zones "}) +
         names + kHint + ": choose another target, raise the load, or use `crane jog`";
}

/// @return true when an axis of the request would move farther than kShortStep_m
bool is_long(const msg::Request& request, const PerAxis& position) {
  constexpr std::size_t kSlew = 1;
  const PerAxis target = runtime::values(request.target);
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double arm = i == kSlew ? std::max(std::abs(position[0]), kShortestRadius_m) : 1;
    if (request.selected[i] && !(arm * std::abs(target[i] - position[i]) <= kShortStep_m)) return true;
  }
  return false;
}

std::string forbidden(Mode mode, const std::string& what, const char* remedy) {
  return std::string{"the crane is in mode "} + name_of(mode) + ", which permits no " + what + ": " + remedy;
}

}  // namespace

std::optional<Request> request_of(crane_RequestKind kind) {
  switch (kind) {
    case crane_REQUEST_RESET:
      return Request::reset;
    case crane_REQUEST_ARM:
      return Request::arm;
    case crane_REQUEST_DISARM:
      return Request::disarm;
    case crane_REQUEST_MOVE:
    case crane_REQUEST_FOLLOW:
    case crane_REQUEST_JOG:
      return Request::move;
    case crane_REQUEST_STOP:
      return Request::stop;
    case crane_REQUEST_ESTOP:
      return Request::estop;
    case crane_REQUEST_HOME:
      return Request::home;
    default:
      return std::nullopt;
  }
}

bool moves_axes(const msg::Request& request) {
  return request.kind == crane_REQUEST_MOVE || request.kind == crane_REQUEST_FOLLOW ||
         request.kind == crane_REQUEST_JOG;
}

std::string problem_of(const msg::Request& request, const Limits& limits) {
  if (request.id == 0 && enabled(request_id)) return "id = 0: a client numbers its requests from 1";
  const bool home = request.kind == crane_REQUEST_HOME, jog = request.kind == crane_REQUEST_JOG;
  if (!moves_axes(request) && !home) return "";
  int selected = 0;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!request.selected[i]) continue;
    ++selected;
    const auto& axis = limits.axis[i];
    if (!axis.present) return std::string{"this rig has no "} + plant::kCoordinates[i].name + " drive";
    if (home || jog) continue;
    if (auto problem = target_problem(request, axis, i); !problem.empty()) return problem;
  }
  if (selected == 0) return "no axis selected";
  if (request.kind == crane_REQUEST_MOVE || jog) return "";
  if (selected != 1) return home ? "home: select exactly one axis" : "follow: select exactly one axis";
  return home ? "" : follow_problem(request, limits);
}

std::string problem_at(const msg::Request& request, const Limits& limits, const PerAxis& position) {
  std::string problem = problem_of(request, limits);
  const bool moves = request.kind == crane_REQUEST_MOVE, follows = request.kind == crane_REQUEST_FOLLOW;
  if (problem.empty() && follows) problem = begin_problem(request, limits, position);
  if (!problem.empty() || (!moves && !follows) || limits.zones.empty()) return problem;
  const PerAxis wanted = runtime::values(request.target);
  if (moves) {
    PerAxis target = position;
    for (std::size_t i = 0; i < kAxes; ++i)
      if (request.selected[i]) target[i] = wanted[i];
    return path_problem(limits, control::path_to(limits.path_space, position, target));
  }
  const auto excursion = excursion_of(request);
  const PerAxis from = control::completed(limits.path_space, position);
  PerAxis low = from, high = from;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!request.selected[i]) continue;
    low[i] = wanted[i] - excursion.distance;
    high[i] = wanted[i] + excursion.distance;
  }
  problem = zone_problem(limits, from, low);
  return problem.empty() && excursion.distance > 0 ? zone_problem(limits, from, high) : problem;
}

std::string problem_in_mode(const msg::Request& request, Mode mode, const PerAxis& position) {
  const ModeRule& rule = rule_of(mode);
  constexpr const char* kChange = "disarm, then choose another mode with `crane mode`";
  if (request.kind == crane_REQUEST_JOG && !rule.stick)
    return forbidden(mode, "driving with the stick", kChange);
  if (request.kind == crane_REQUEST_FOLLOW && !rule.excitation) return forbidden(mode, "excitation", kChange);
  if (request.kind != crane_REQUEST_MOVE || rule.moves == Moves::all) return "";
  if (rule.moves == Moves::none) return forbidden(mode, "moves", kChange);
  if (!is_long(request, position)) return "";
  return forbidden(mode, "move of more than " + std::to_string(std::lround(1e3 * kShortStep_m)) + " mm",
                   "move in shorter steps, or drive with `crane jog`");
}

std::string mode_problem(const msg::Request& request, State state) {
  if (static_cast<std::size_t>(request.mode) >= kModes) return "mode: must be " + mode_names();
  switch (state) {
    case State::boot:
    case State::selftest:
    case State::locked:
    case State::ready:
    case State::estop:
    case State::fault:
      return "";
    default:
      return "the mode does not change while the crane is arming, armed or stopping: disarm first";
  }
}

std::size_t home_axis_of(const msg::Request& request) {
  const auto* found = std::find(std::begin(request.selected), std::end(request.selected), true);
  return found == std::end(request.selected) ? 0
                                             : static_cast<std::size_t>(found - std::begin(request.selected));
}

std::string OncePerTick::problem_of(const msg::Request& request, const Limits& limits) {
  if (request.kind == crane_REQUEST_MOVE && !limits.zones.empty() && std::exchange(searched_, true))
    return "another move was requested in this tick: repeat the request";
  if (request.kind == crane_REQUEST_HOME && std::exchange(homed_, true))
    return "homing of an axis was already requested in this tick: repeat the request when that homing has "
           "ended";
  return "";
}

}  // namespace crane::supervisor
