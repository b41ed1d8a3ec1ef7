#pragma once
/// What the simulated board is told about its rig. The defaults are the dissertation's tower crane.
#include <array>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "crane/bridge/board.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/plant/state.hpp"

namespace crane::simulator {

/// Incremental encoder of one coordinate: raw = nearest integer of sign * (coordinate - zero) *
/// counts_per_unit.
struct SimulatedEncoder {
  double counts_per_unit = 1;  ///< counts per m or rad of the coordinate (quadrature and gear included), > 0
  int sign = 1;                ///< +1 or -1: which way it counts
  double zero = 0;             ///< coordinate at which it shows 0, m or rad
};

struct SimulatedDrive {
  bool present = true;               ///< an absent drive never moves
  int sign = 1;                      ///< +1 or -1: which way a positive voltage moves the axis
  double brake_deceleration = 5;     ///< m/s2 or rad/s2 that the closed brake gives alone, > 0
  double brake_close_time_s = 0.02;  ///< from loss of supply to full effort, in [0, 10]
  double brake_open_time_s = 0.02;   ///< from supply to no effort, in [0, 10]
  double low_switch = -std::numeric_limits<double>::infinity();  ///< limit_low while the position is <= this
  double high_switch = std::numeric_limits<double>::infinity();  ///< limit_high while the position is >= this
  double mark =
      -std::numeric_limits<double>::infinity();  ///< the axis' own mark shows while the position is <= this
  double low_stop = -std::numeric_limits<double>::infinity();  ///< end stop: the axis is stopped dead here
  double high_stop = std::numeric_limits<double>::infinity();
};

struct SimulatedRig {
  plant::Parameters parameters;
  std::vector<plant::TermSetting> terms;
  std::array<SimulatedDrive, bridge::kDrives> drives{};
  /// Trolley: 2000 lines x 4 per 0.0127 m; slew: 2000 x 4 x 45 per turn; hoist: 2000 x 4 per 0.05 m of cable;
  /// radial and tangential swing: 6000 x 4 per turn.
  std::array<SimulatedEncoder, bridge::kCounters> encoders{{{2000 * 4 / 0.0127},
                                                            {2000 * 4 * 45 / kTurn},
                                                            {2000 * 4 / 0.05},
                                                            {6000 * 4 / kTurn},
                                                            {6000 * 4 / kTurn}}};
  bool radial_swing = true;      ///< false: the cable cannot swing that way
  bool tangential_swing = true;  ///< false for a gantry
  plant::State start{.trolley_m = 0.25};
  double period_s = 0.01;            ///< tick, in which command and sensor terms act once, > 0
  bool estop_cuts_brakes = true;     ///< the wired emergency stop interrupts the brake supply
  double watchdog_timeout_s = 0.05;  ///< the relay drops when the level has not changed for longer than this
  double watchdog_permit_s =
      0.05;  ///< a dropped relay closes again after toggling for this long without a gap

  /// All problems at once as "name = value: rule", terms included; empty when usable.
  [[nodiscard]] std::vector<std::string> problems() const;

 private:
  static constexpr double kTurn = 2 * std::numbers::pi;
};

}  // namespace crane::simulator
