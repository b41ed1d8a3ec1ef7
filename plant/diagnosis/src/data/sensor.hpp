#pragma once
/// Resolution and noise of a sensor, estimated from its values.
#include <span>

namespace crane::diagnosis {

struct Sensor {
  double resolution = 0;  ///< step of the lattice of the values, else their smallest difference
  double noise = 0;       ///< standard deviation, from third differences
  /// Error of a value.
  [[nodiscard]] double error() const { return resolution > noise ? resolution : noise; }
};

/// @param values not finite ones are ignored
[[nodiscard]] Sensor sensor_of(std::span<const double> values);

}  // namespace crane::diagnosis
