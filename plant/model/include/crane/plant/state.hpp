#pragma once
/// State of the crane. Position of the load in the jib frame, (2.11) of H. M. Omar, Control of Gantry and
/// Tower Cranes:
///   r_L = {x - L cos(theta) sin(phi), L sin(theta), -L cos(theta) cos(phi)}
/// phi (radial swing) is positive when the load is towards the tower. theta (tangential swing) is positive
/// when the load is ahead in the direction of +slew (docs/equations.md#coordinates-and-signs).
#include <array>
#include <bit>

#include "crane/plant/parameters.hpp"

namespace crane::plant {

struct State {
  double trolley_m = 0;       ///< x, distance from the tower axis
  double radial_rad = 0;      ///< phi, |phi| < pi/2
  double slew_rad = 0;        ///< gamma
  double tangential_rad = 0;  ///< theta, |theta| < pi/2: the equations are singular at pi/2
  double cable_m = 1;         ///< L, > 0
  double trolley_mps = 0;
  double radial_radps = 0;
  double slew_radps = 0;
  double tangential_radps = 0;
  double cable_mps = 0;

  friend bool operator==(const State&, const State&) = default;
};

/// The ten numbers of State as an array, in the order of its members, for integrators.
inline constexpr std::size_t kStateSize = 10;
using StateArray = std::array<double, kStateSize>;
static_assert(sizeof(State) == sizeof(StateArray));
[[nodiscard]] inline StateArray to_array(const State& state) { return std::bit_cast<StateArray>(state); }
[[nodiscard]] inline State to_state(const StateArray& values) { return std::bit_cast<State>(values); }

/// Index of the position of each axis in StateArray. The index of its speed is larger by kSpeedOffset.
inline constexpr std::array<std::size_t, kAxes> kPositionIndex{0, 2, 4};
inline constexpr std::size_t kSpeedOffset = 5;

inline constexpr std::array kAxisPosition{&State::trolley_m, &State::slew_rad, &State::cable_m};
inline constexpr std::array kAxisSpeed{&State::trolley_mps, &State::slew_radps, &State::cable_mps};

/// Position and speed of one driven axis [m, rad, m of cable; per second].
[[nodiscard]] inline double position(const State& s, Axis axis) { return s.*kAxisPosition[axis]; }
[[nodiscard]] inline double speed(const State& s, Axis axis) { return s.*kAxisSpeed[axis]; }

}  // namespace crane::plant
