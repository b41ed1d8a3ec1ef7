#pragma once
/// Codes of the 13-bit, +-10 V converters of the Servo-to-Go card and of the simulated board, in inverted
/// offset binary: 0x0000 is +10 V, 0x1000 is 0 V, one step is 20 V / 8192.
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace crane::bridge {

inline constexpr std::uint16_t kConverterZero = 0x1000;
inline constexpr std::uint16_t kConverterLargest = 0x1FFF;
inline constexpr double kConverterRange_v = 10;

/// Code of a voltage: clamp(0x1000 - round(V / 10 * 0x1000), 0, 0x1FFF). A voltage that is not finite has the
/// code of 0 V.
[[nodiscard]] inline std::uint16_t converter_code(double voltage_v) noexcept {
  if (!std::isfinite(voltage_v)) return kConverterZero;
  const double steps = std::round(voltage_v / kConverterRange_v * kConverterZero);
  return static_cast<std::uint16_t>(std::clamp(kConverterZero - steps, 0.0, double{kConverterLargest}));
}

/// Voltage of a code, from +10 V (0) to -9.99756 V (0x1FFF).
[[nodiscard]] inline double converter_voltage_v(std::uint16_t code) noexcept {
  return (kConverterZero - code) * (kConverterRange_v / kConverterZero);
}

}  // namespace crane::bridge
