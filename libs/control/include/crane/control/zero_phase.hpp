#pragma once
/// Low-pass filter without phase shift, for recorded data: a Butterworth filter runs forwards and then
/// backwards over the samples. It needs future samples and cannot be used in the control loop. Source: H. M.
/// Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003, section 3.1.2.
#include <span>
#include <vector>

#include "crane/control/filters.hpp"

namespace crane::control {

/// Sections of a Butterworth low-pass filter, to be applied in series. For an odd `order` the last section
/// has first order. The series has -3 dB at cutoff_ratio * f_s (bilinear transform with prewarping).
/// @throws std::invalid_argument unless cutoff_ratio in [1e-4, 0.5) and order in 1..12
[[nodiscard]] std::vector<FilterSection> butterworth_sections(double cutoff_ratio, int order);

/// Filters `samples` in both directions. The gain is 1/(1 + W^(2 order)) with W = tan(pi f/f_s) / tan(pi
/// cutoff_ratio), one half at the cut-off frequency; the phase is zero at every frequency. Both passes start
/// settled. The filter extends the samples at both ends by their odd reflection, 2 x_0 - x_k, so that a
/// constant and a straight line do not change.
/// @param samples       equally spaced in time and finite; fewer than two samples are returned unchanged
/// @param cutoff_ratio  cut-off frequency / sampling frequency, in [1e-4, 0.5)
/// @param order         order of one pass, 1..12; the source uses 5
/// @return as many values as `samples`; a sample that is not finite makes all values non-finite
/// @throws std::invalid_argument when cutoff_ratio or order is outside its range
[[nodiscard]] std::vector<double> zero_phase_butterworth(std::span<const double> samples, double cutoff_ratio,
                                                         int order = 5);

}  // namespace crane::control
