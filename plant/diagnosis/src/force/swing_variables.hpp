#pragma once
/// Variables that an error of the swing may depend on.
#include <string>
#include <vector>

#include "shooting/problem.hpp"

namespace crane::diagnosis {

/// By window and row.
using WindowSignal = std::vector<std::vector<double>>;

/// factor * f(value): f is linear between the centres of the bins, which divide the range of `value`.
struct SwingVariable {
  std::string name;
  bool of_sensor = false;  ///< the pattern adds to the measured swing, else to the force on the load
  std::size_t bins = 1;
  WindowSignal value, factor;
  bool of_own_swing = false;  ///< swing of this output, or its rate
};

/// Variables of one output: swing, rate of the swing, time, position and speed of the drives, other swing;
/// each for a force and for an error of the sensor. Variables that are constant in the data are omitted.
/// @param index of the output in the problem
[[nodiscard]] std::vector<SwingVariable> swing_variables_of(const Problem& problem, const Fits& fits,
                                                            std::size_t index);

}  // namespace crane::diagnosis
