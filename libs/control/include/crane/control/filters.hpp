#pragma once
/// Differentiators and low-pass filter. Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia
/// Tech, 2003, section 4.3. Each filter is one second-order section
///   y(k) = b0 x(k) + b1 x(k-1) + b2 x(k-2) - a1 y(k-1) - a2 y(k-2)
/// The memory is separate. Initialise it with settled() at the first sample to avoid a transient.

namespace crane::control {

struct FilterSection {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;  ///< default: output equals input
};

struct FilterMemory {
  double x1 = 0, x2 = 0, y1 = 0, y2 = 0;  ///< inputs and outputs of the last two ticks
};

/// Filters one sample; allocates no memory. The output is finite while |sample| is below 1e300 divided by the
/// gain of the section.
[[nodiscard]] double step(const FilterSection& section, FilterMemory& memory, double sample) noexcept;

/// Steady-state memory for the constant input `sample`.
[[nodiscard]] FilterMemory settled(const FilterSection& section, double sample) noexcept;

/// y(k) = f_s (x(k) - x(k-1))                                                      (4.8)
[[nodiscard]] FilterSection backward_difference(double sample_rate_hz) noexcept;
/// y(k) = -y(k-1)/7 + 8 f_s/7 (x(k) - x(k-1))                                      (4.9)
[[nodiscard]] FilterSection al_alaoui_first_order(double sample_rate_hz) noexcept;
/// y(k) = -2q y(k-1) - q^2 y(k-2) + 3 f_s/(2 + sqrt 3) (x(k) - x(k-2)), q = 2 - sqrt 3    (4.10), corrected
[[nodiscard]] FilterSection al_alaoui_second_order(double sample_rate_hz) noexcept;
/// Second-order Butterworth filter (bilinear transform with prewarping), -3 dB at cutoff_ratio * f_s.
/// @param cutoff_ratio  cut-off frequency / sampling frequency, in (0, 0.5); 0.05 in the source; or 0: no
///   filter
[[nodiscard]] FilterSection butterworth_low_pass(double cutoff_ratio) noexcept;

}  // namespace crane::control
