#pragma once
/// Parameters of the simulated board. The defaults are those of the tower crane in H. M. Omar, Control of
/// Gantry and Tower Cranes, Virginia Tech, 2003, chapter 4.
#include <array>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "crane/bridge/board.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/plant/state.hpp"
#include "crane/simulator/integrator.hpp"

namespace crane::simulator {

/// Incremental encoder of one coordinate: raw = nearest integer of sign * (coordinate - zero) *
/// counts_per_unit.
struct SimulatedEncoder {
  double counts_per_unit = 1;  ///< counts per m or rad, including quadrature and gear, > 0
  int sign = 1;                ///< +1 or -1: direction of counting
  double zero = 0;             ///< coordinate of count 0, m or rad
};

struct SimulatedDrive {
  bool present = true;               ///< false: the axis never moves
  int sign = 1;                      ///< +1 or -1: direction of motion for a positive voltage
  double brake_deceleration = 5;     ///< deceleration by the closed brake alone, m/s2 or rad/s2, > 0
  double brake_close_time_s = 0.02;  ///< time from loss of supply to full braking force, in [0, 10]
  double brake_open_time_s = 0.02;   ///< time from supply to zero braking force, in [0, 10]
  /// limit_low is set while position <= low_switch, limit_high while position >= high_switch, and the
  /// separate mark is active while position <= mark; m or rad.
  double low_switch = -std::numeric_limits<double>::infinity();
  double high_switch = std::numeric_limits<double>::infinity();
  double mark = -std::numeric_limits<double>::infinity();
  double low_stop = -std::numeric_limits<double>::infinity();  ///< position of the low end stop, m or rad
  double high_stop = std::numeric_limits<double>::infinity();  ///< position of the high end stop, m or rad
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
  bool radial_swing = true;      ///< false: no radial swing
  bool tangential_swing = true;  ///< false for a gantry
  plant::State start{.trolley_m = 0.25};
  Method integrator = Method::cvode;
  /// Sampling period, > 0. The command terms act once per period, the sensor terms once per time at
  /// which the board is read.
  double period_s = 0.01;
  bool estop_cuts_brakes = true;     ///< true: the emergency stop interrupts the brake supply by wire
  double watchdog_timeout_s = 0.05;  ///< the relay opens when the level has not changed for longer than this
  double watchdog_permit_s = 0.05;   ///< an open relay closes after uninterrupted toggling for this time

  /// @return all problems as "name = value: rule", including those of the terms; empty when there are none
  [[nodiscard]] std::vector<std::string> problems() const;

 private:
  static constexpr double kTurn = 2 * std::numbers::pi;
};

}  // namespace crane::simulator
