#include "crane/fields/unit.hpp"

#include <algorithm>
#include <array>

#include "crane/fields/angle.hpp"

namespace crane::fields {
namespace {

constexpr Dimension kLength{.length = 1}, kAngle{.angle = 1}, kTime{.time = 1}, kVoltage{.voltage = 1},
    kFrequency{.time = -1};

/// Dimension of a quantity per second to the power of `order`.
constexpr Dimension derivative(Dimension of, std::int8_t order) {
  of.time = static_cast<std::int8_t>(of.time - order);
  return of;
}

constexpr std::array kUnits{
    Unit{"m", "m", 1, kLength},
    Unit{"cm", "cm", 1e-2, kLength},
    Unit{"mm", "mm", 1e-3, kLength},
    Unit{"rad", "rad", 1, kAngle},
    Unit{"deg", "deg", kRadPerDeg, kAngle},
    Unit{"s", "s", 1, kTime},
    Unit{"ms", "ms", 1e-3, kTime},
    Unit{"us", "us", 1e-6, kTime},
    Unit{"ns", "ns", 1e-9, kTime},
    Unit{"V", "v", 1, kVoltage},
    Unit{"mV", "mv", 1e-3, kVoltage},
    Unit{"Hz", "hz", 1, kFrequency},
    Unit{"m/s", "mps", 1, derivative(kLength, 1)},
    Unit{"cm/s", "cmps", 1e-2, derivative(kLength, 1)},
    Unit{"mm/s", "mmps", 1e-3, derivative(kLength, 1)},
    Unit{"rad/s", "radps", 1, derivative(kAngle, 1)},
    Unit{"deg/s", "degps", kRadPerDeg, derivative(kAngle, 1)},
    Unit{"m/s^2", "mps2", 1, derivative(kLength, 2)},
    Unit{"rad/s^2", "radps2", 1, derivative(kAngle, 2)},
    Unit{"deg/s^2", "degps2", kRadPerDeg, derivative(kAngle, 2)},
    Unit{"V/s", "vps", 1, derivative(kVoltage, 1)},
};

constexpr std::int8_t plus(int a, int b) { return static_cast<std::int8_t>(std::clamp(a + b, -100, 100)); }

}  // namespace

Dimension operator*(Dimension a, Dimension b) {
  return {plus(a.length, b.length), plus(a.angle, b.angle), plus(a.time, b.time), plus(a.voltage, b.voltage)};
}

Dimension operator/(Dimension a, Dimension b) {
  return {plus(a.length, -b.length), plus(a.angle, -b.angle), plus(a.time, -b.time),
          plus(a.voltage, -b.voltage)};
}

std::span<const Unit> units() { return kUnits; }

const Unit* unit_with_symbol(std::string_view symbol) {
  const auto* const found = std::ranges::find(kUnits, symbol, &Unit::symbol);
  return found == kUnits.end() ? nullptr : found;
}

const Unit* unit_of_name(std::string_view name) {
  const auto underscore = name.rfind('_');
  if (underscore == std::string_view::npos) return nullptr;
  const auto* const found = std::ranges::find(kUnits, name.substr(underscore + 1), &Unit::suffix);
  return found == kUnits.end() ? nullptr : found;
}

std::string text_of(Dimension dimension) {
  if (dimension == Dimension{}) return "1";
  const auto* const found = std::ranges::find(kUnits, dimension, &Unit::dimension);
  if (found != kUnits.end()) return std::string{found->symbol};
  std::string text;
  const auto factor = [&text](const char* unit, int exponent) {
    if (exponent == 0) return;
    text +=
        (text.empty() ? "" : " ") + std::string{unit} + (exponent == 1 ? "" : "^" + std::to_string(exponent));
  };
  factor("m", dimension.length);
  factor("rad", dimension.angle);
  factor("s", dimension.time);
  factor("V", dimension.voltage);
  return text;
}

std::string symbols_of(Dimension dimension) {
  std::string symbols;
  for (const auto& unit : kUnits)
    if (unit.dimension == dimension) symbols += (symbols.empty() ? "" : ", ") + std::string{unit.symbol};
  return symbols;
}

}  // namespace crane::fields
