#include "crane/control/filters.hpp"

#include <cmath>
#include <numbers>

namespace crane::control {

double step(const FilterSection& section, FilterMemory& memory, double sample) noexcept {
  const double output = section.b0 * sample + section.b1 * memory.x1 + section.b2 * memory.x2 -
                        section.a1 * memory.y1 - section.a2 * memory.y2;
  memory = {sample, memory.x1, output, memory.y1};
  return output;
}

FilterMemory settled(const FilterSection& section, double sample) noexcept {
  const double gain = (section.b0 + section.b1 + section.b2) / (1 + section.a1 + section.a2);
  return {sample, sample, gain * sample, gain * sample};
}

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes (filters.hpp).

FilterSection backward_difference(double sample_rate_hz) noexcept {  // (4.8)
  return {sample_rate_hz, -sample_rate_hz, 0, 0, 0};
}

FilterSection al_alaoui_first_order(double sample_rate_hz) noexcept {  // (4.9)
  const double gain = 8 * sample_rate_hz / 7;
  return {gain, -gain, 0, 1.0 / 7, 0};
}

FilterSection al_alaoui_second_order(double sample_rate_hz) noexcept {  // (4.10)
  const double q = 2 - std::numbers::sqrt3;
  const double gain = 3 * sample_rate_hz / (2 + std::numbers::sqrt3);
  return {gain, 0, -gain, 2 * q, q * q};
}

FilterSection butterworth_low_pass(double cutoff_ratio) noexcept {
  if (!(cutoff_ratio > 0)) return {};
  const double w = std::tan(std::numbers::pi * cutoff_ratio);  // prewarped cut-off frequency
  const double norm = 1 / (1 + std::numbers::sqrt2 * w + w * w);
  const double gain = w * w * norm;
  return {gain, 2 * gain, gain, 2 * (w * w - 1) * norm, (1 - std::numbers::sqrt2 * w + w * w) * norm};
}

}  // namespace crane::control
