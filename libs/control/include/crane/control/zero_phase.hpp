#pragma once
/// Low-pass without delay for work on recordings, section 3.1.2: a Butterworth filter run forwards and then
/// backwards. Not for the loop: it knows the future.
#include <span>
#include <vector>

#include "crane/control/filters.hpp"

namespace crane::control {

/// Butterworth low-pass of any order as second-order sections, the last of first order where `order` is odd;
/// bilinear, together exactly -3 dB at cutoff_ratio * f_s. Run one after another.
/// @throws std::invalid_argument unless cutoff_ratio in [1e-4, 0.5) and order in 1..12
[[nodiscard]] std::vector<FilterSection> butterworth_sections(double cutoff_ratio, int order);

/// The series without what is faster than the cut-off, at its old place in time: gain 1/(1 + W^(2 order))
/// with W = tan(pi f/f_s) / tan(pi cutoff_ratio), so one half at the cut-off; phase zero at every frequency.
/// Both passes begin settled and run over the ends continued by their odd reflection, 2 x_0 - x_k, so that a
/// constant and a straight line pass unchanged.
/// @param samples       equally spaced; none or one come back as they are
/// @param cutoff_ratio  cut-off over sampling frequency, in [1e-4, 0.5)
/// @param order         of one pass, 1..12; the dissertation uses 5
/// @return as many values as `samples`
/// @throws std::invalid_argument when cutoff_ratio or order are outside their range; a sample that is not
/// finite spoils its series
[[nodiscard]] std::vector<double> zero_phase_butterworth(std::span<const double> samples, double cutoff_ratio,
                                                         int order = 5);

}  // namespace crane::control
