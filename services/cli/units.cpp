#include "cli/units.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

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

struct Scale {
  std::string_view symbol;
  double factor;
};
constexpr std::array kLongTimes{Scale{"min", 60}, Scale{"h", 3600}, Scale{"d", 86400}};
constexpr std::array kSizes{Scale{"", 1},
                            Scale{"B", 1},
                            Scale{"kB", 1e3},
                            Scale{"MB", 1e6},
                            Scale{"GB", 1e9},
                            Scale{"TB", 1e12},
                            Scale{"KiB", 1024.0},
                            Scale{"MiB", 1024.0 * 1024},
                            Scale{"GiB", 1024.0 * 1024 * 1024}};

struct NumberAndUnit {
  double number;
  std::string_view symbol;
};
std::optional<NumberAndUnit> split(std::string_view text) {
  const auto rest = trimmed(text);
  double number = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
  if (error != std::errc{} || !std::isfinite(number)) return std::nullopt;
  return NumberAndUnit{number, trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())))};
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

double parse_duration(std::string_view text) {
  const auto parts = split(text);
  double duration_s = 0;
  const auto* const scale =
      parts ? std::ranges::find(kLongTimes, parts->symbol, &Scale::symbol) : kLongTimes.end();
  if (scale != kLongTimes.end())
    duration_s = parts->number * scale->factor;
  else
    duration_s = parse_quantity(text, Dimension::time);
  if (!(duration_s > 0)) throw UnitError("'" + std::string{text} + "' is not a positive time");
  return duration_s;
}

std::uint64_t parse_bytes(std::string_view text) {
  const auto quoted = "'" + std::string{text} + "'";
  const auto parts = split(text);
  const auto* const scale = parts ? std::ranges::find(kSizes, parts->symbol, &Scale::symbol) : kSizes.end();
  if (scale == kSizes.end())
    throw UnitError(quoted + " is not a size; for example 500MB, 2GB, 1GiB (without a unit: bytes)");
  const double bytes = parts->number * scale->factor;
  constexpr double kLargest = 1e18;
  if (!(bytes >= 1 && bytes <= kLargest)) throw UnitError(quoted + " is not between 1 byte and 1e18 bytes");
  return static_cast<std::uint64_t>(bytes);
}

}  // namespace crane::cli
