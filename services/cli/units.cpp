#include "cli/units.hpp"

#include <charconv>
#include <cmath>

#include "crane/fields/unit.hpp"

namespace crane::cli {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

struct Kind {
  fields::Dimension dimension;
  const char *name, *examples;
};

Kind kind_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return {{.length = 1}, "length", "1.05, 1.05m, 105cm"};
    case Dimension::angle:
      return {{.angle = 1}, "angle", "1.57, 1.57rad, 90deg"};
    case Dimension::time:
      break;
  }
  return {{.time = 1}, "time", "1.5, 1.5s, 20ms"};
}

}  // namespace

double parse_quantity(std::string_view text, Dimension dimension) {
  const Kind kind = kind_of(dimension);
  const std::string quoted = "'" + std::string{text} + "'";
  auto rest = trimmed(text);
  if (rest.starts_with('+') && !rest.starts_with("+-")) rest.remove_prefix(1);  // from_chars rejects '+'
  double number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc{} || !std::isfinite(number))
    throw UnitError(quoted + " is not a number with a unit; for example " + kind.examples);
  const auto symbol = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  if (symbol.empty()) return number;
  if (const auto* const unit = fields::unit_with_symbol(symbol);
      unit != nullptr && unit->dimension == kind.dimension)
    return number * unit->factor;
  auto permitted = fields::symbols_of(kind.dimension);
  permitted.insert(permitted.find(','), " (default)");
  throw UnitError(quoted + ": unit '" + std::string{symbol} + "' is no unit of " + kind.name + ": use " +
                  permitted);
}

}  // namespace crane::cli
