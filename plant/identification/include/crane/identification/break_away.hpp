#pragma once
/// Estimates the stiction: the voltage at which a resting axis starts to move (break-away). The experiment
/// raises the voltage slowly from rest until the axis moves, several times in both directions. Source: H. M.
/// Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 3.1, (4.13), (4.15).
#include "crane/identification/friction.hpp"

namespace crane::identification {

struct BreakAwayOptions {
  double start_speed = 0.002;  ///< speed above which the axis counts as moving, m/s or rad/s, > 0
  double rest_s = 0.2;         ///< minimum time at rest before a break-away, > 0
  double window_s = 0.05;      ///< time between the two positions that determine the speed, > 0
};

struct BreakAway {
  double time_s = 0;
  double drive_v = 0;  ///< voltage in the middle of the window, V, signed
};

/// All break-aways in the direction of the voltage, in order of time. The bias of drive_v is b start_speed
/// (b: viscous friction) plus half the window times the slope of the voltage.
/// @throws IdentificationError when the series are too short, not finite or of different lengths
/// @throws std::invalid_argument when an option is not > 0
[[nodiscard]] std::vector<BreakAway> break_aways(const AxisRun& run, const BreakAwayOptions& options);

/// Stiction in one direction.
struct Stiction {
  double mean_v = 0;    ///< mean of |drive_v|, V
  double spread_v = 0;  ///< standard deviation of single break-aways, V
  std::size_t count = 0;
};
struct StictionEstimate {
  Stiction positive, negative;
};
inline constexpr std::size_t kFewestBreakAways = 2;

/// @throws IdentificationError when a direction has fewer than kFewestBreakAways
[[nodiscard]] StictionEstimate estimate_stiction(const AxisRun& run, const BreakAwayOptions& options);

}  // namespace crane::identification
