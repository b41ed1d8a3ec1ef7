#pragma once
/// Differentiators and low-pass of section 4.3. Each is one second-order section
///   y(k) = b0 x(k) + b1 x(k-1) + b2 x(k-2) - a1 y(k-1) - a2 y(k-2)
/// with its memory apart: start with settled() at the first sample and there is no transient.

namespace crane::control {

struct FilterSection {
  double b0 = 1, b1 = 0, b2 = 0, a1 = 0, a2 = 0;  ///< passes its input as it stands
};

struct FilterMemory {
  double x1 = 0, x2 = 0, y1 = 0, y2 = 0;  ///< inputs and outputs one and two ticks ago
};

/// One tick. No allocation; finite while the input's size stays below 1e300 over the section's gain.
[[nodiscard]] double step(const FilterSection& section, FilterMemory& memory, double sample) noexcept;

/// Memory after `sample` for ever.
[[nodiscard]] FilterMemory settled(const FilterSection& section, double sample) noexcept;

/// y(k) = f_s (x(k) - x(k-1))                                                      (4.8)
[[nodiscard]] FilterSection backward_difference(double sample_rate_hz) noexcept;
/// y(k) = -y(k-1)/7 + 8 f_s/7 (x(k) - x(k-1))                                      (4.9)
[[nodiscard]] FilterSection al_alaoui_first_order(double sample_rate_hz) noexcept;
/// y(k) = -2q y(k-1) - q^2 y(k-2) + 3 f_s/(2 + sqrt 3) (x(k) - x(k-2)), q = 2 - sqrt 3    (4.10), corrected
[[nodiscard]] FilterSection al_alaoui_second_order(double sample_rate_hz) noexcept;
/// Second-order Butterworth, bilinear, exactly -3 dB at cut_off_ratio * f_s.
/// @param cut_off_ratio cut-off over sampling frequency, in (0, 0.5); the dissertation uses 0.05. 0 passes as
/// is
[[nodiscard]] FilterSection butterworth_low_pass(double cut_off_ratio) noexcept;

}  // namespace crane::control
