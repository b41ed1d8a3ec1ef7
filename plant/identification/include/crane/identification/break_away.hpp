#pragma once
/// Stiction: the control action at which the motor starts to move (section 3.1, (4.13), (4.15)). The axis
/// rests while its voltage is raised slowly, until it moves; both ways, several times.
#include "crane/identification/friction.hpp"

namespace crane::identification {

struct BreakAwayOptions {
  double start_speed = 0.002;  ///< m/s or rad/s that count as motion, > 0
  double rest_s = 0.2;         ///< slower than that for so long before, > 0
  double window_s = 0.05;      ///< the speed is a difference of positions so far apart, > 0
};

struct BreakAway {
  double time_s = 0;
  double drive_v = 0;  ///< V in the middle of the window, signed
};

/// Every start out of rest in the direction of its voltage, in order of time. The speed threshold costs
/// b start_speed, the window half its length times the slope of the ramp.
/// @throws IdentificationError as estimate_friction does for the series, @throws std::invalid_argument
[[nodiscard]] std::vector<BreakAway> break_aways(const AxisRun& run, const BreakAwayOptions& options);

struct Stiction {
  double mean_v = 0;    ///< magnitude
  double spread_v = 0;  ///< standard deviation of single break-aways
  std::size_t count = 0;
};
struct StictionEstimate {
  Stiction positive, negative;
};
inline constexpr std::size_t kFewestBreakAways = 2;

/// @throws IdentificationError  fewer than kFewestBreakAways in a direction
[[nodiscard]] StictionEstimate estimate_stiction(const AxisRun& run, const BreakAwayOptions& options);

}  // namespace crane::identification
