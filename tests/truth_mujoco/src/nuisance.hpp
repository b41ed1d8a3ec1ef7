#pragma once
/// Conditions that differ between laboratories and are not faults. They are drawn for every set from wide
/// ranges.
#include <string>
#include <vector>

#include "chance.hpp"
#include "physics.hpp"

namespace mujoco_truth {

/// One row of the table: uniform on a logarithmic scale from `low` to `high`; 0 with the probability `none`.
struct Range {
  const char* name;
  const char* unit;
  double low, high, none;
};

// The table of README.md.
inline constexpr Range kDisturbance{"disturbance", "N rms on the load, each way", 0.003, 0.5, 0.1};
inline constexpr Range kDriveDisturbance{"drive_disturbance", "V rms at each drive", 0.001, 0.08, 0.1};
inline constexpr Range kCorrelation{"correlation", "s", 0.05, 2, 0};
inline constexpr Range kSwing{"swing", "degrees, 95th percentile of the training runs", 0.5, 25, 0};
inline constexpr Range kRate{"rate", "Hz", 20, 500, 0};
inline constexpr Range kJitter{"jitter", "share of the row interval, uniform", 0.02, 0.3, 0.5};
inline constexpr Range kDropped{"dropped", "share of the rows", 0.002, 0.1, 0.5};
inline constexpr Range kResolution{"resolution", "times the counts of the base rig", 0.01, 100, 0};
inline constexpr Range kNoise{"noise", "counts rms before rounding", 0.1, 2, 0.2};
inline constexpr Range kPresliding{"presliding", "m or rad", 1e-5, 5e-5, 0};
/// largest relative deviation of a number from that of the base rig
inline constexpr double kGeometry = 0.5;

enum class Controller { position_pd, friction_compensated, open_loop, operator_jog };
[[nodiscard]] const char* name_of(Controller controller);

struct Nuisance {
  double disturbance_n = 0, drive_disturbance_v = 0, correlation_s = 0.5;
  double swing_rad = 0.1;  ///< desired swing; for a drive axis the share of its travel replaces it
  double rate_hz = 100, jitter = 0, dropped = 0;
  double swing_resolution = 1, position_resolution = 1, noise_counts = 0.3;
  StandstillLaw law = StandstillLaw::dahl;
  double presliding_m = 2e-5;
  Controller controller = Controller::position_pd;
  double bandwidth_radps = 3, anti_swing = 0;
  bool foreign_columns = false;   ///< true: the columns have other names and units, with a mapping
  bool states_resolution = true;  ///< true: the rig file contains the counts of the sensors
  double geometry = 0;            ///< rms of the relative changes of the base rig, of at most kGeometry
};

[[nodiscard]] double draw(const Range& range, Chance& chance);
[[nodiscard]] Nuisance drawn_nuisance(Chance& chance);
/// A rig of this kind near the base rig. The numbers are rounded to 4 digits, so that the rig file is exact.
[[nodiscard]] Rig drawn_rig(Kind kind, const Nuisance& nuisance, Chance& chance, double& geometry);

}  // namespace mujoco_truth
