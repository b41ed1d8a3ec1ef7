#pragma once
/// Test of "a disturbance explains the residual of a swing" by the size of the force.
#include "shooting/problem.hpp"

namespace crane::diagnosis {

/// Rms of the measured values of an output about the mean of their window, m or rad; 0 without windows.
[[nodiscard]] double rms_motion(const Problem& problem, std::size_t output);

/// Standard deviation of the white noise in the measured values of an output, m or rad: from the median of
/// the third differences, to which a smooth motion contributes little (P. J. Rousseeuw, C. Croux, J. Amer.
/// Statist. Assoc. 88 (1993) 1273). 0 without four consecutive measured rows.
[[nodiscard]] double measured_noise(const Problem& problem, std::size_t output);

/// Rms residual of an output in windows over the rms motion in the windows, both without the noise of the
/// sensor; 0 if the output hardly moves.
/// @param output index into the outputs of the problem, which is not whitened
/// @param noise standard deviation of the sensor, m or rad
[[nodiscard]] double share_not_followed(const Problem& problem, const Fits& fits, std::size_t output,
                                        double noise);

/// Rms of the missing force on the load, as a share of the weight: F / m g = r'' / w^2 + r with the residual
/// r and the natural frequency w. The second difference spans an eighth of a period. The variance that white
/// noise of the sensor adds is subtracted.
/// @param output index into the outputs of the problem, which is not whitened
/// @param noise standard deviation of the sensor, rad
[[nodiscard]] double missing_force(const Problem& problem, const Fits& fits, std::size_t output,
                                   double natural_radps, double noise);

}  // namespace crane::diagnosis
