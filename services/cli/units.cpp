#include "cli/units.hpp"

#include <charconv>
#include <cmath>
#include <span>

#include "crane/fields/angle.hpp"

namespace crane::cli {
namespace {

struct Unit {
  std::string_view name;
  double factor;
};
constexpr Unit kLengths[]{{"", 1}, {"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}};
constexpr Unit kAngles[]{{"", 1}, {"rad", 1}, {"deg", fields::kRadPerDeg}};

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

double parse_quantity(std::string_view text, Dimension dimension) {
  const bool length = dimension == Dimension::length;
  const std::string quoted = "'" + std::string{text} + "'";
  auto rest = trimmed(text);
  if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);  // from_chars rejects '+'
  double number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc{} || !std::isfinite(number))
    throw UnitError(quoted + " is not a number with a unit; for example " +
                    (length ? "1.05, 1.05m, 105cm" : "1.57, 1.57rad, 90deg"));
  const auto unit = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  for (const auto& known : length ? std::span<const Unit>{kLengths} : std::span<const Unit>{kAngles})
    if (known.name == unit) return number * known.factor;
  throw UnitError(quoted + ": unit '" + std::string{unit} + "' is no unit of " +
                  (length ? "length: use m (default), cm, mm" : "angle: use rad (default), deg"));
}

}  // namespace crane::cli
