#pragma once
/// What the values of a column show of its sensor.
#include <span>

namespace crane::diagnosis {

struct Sensor {
  double resolution = 0;  ///< smallest step: of a lattice that the values lie on, or between any two of them
  double noise = 0;       ///< standard deviation of what changes from row to row as no motion does
  /// What a value may lie beside the truth, whatever the motion.
  [[nodiscard]] double error() const { return resolution > noise ? resolution : noise; }
};

/// @param values not finite ones are passed over
[[nodiscard]] Sensor sensor_of(std::span<const double> values);

}  // namespace crane::diagnosis
