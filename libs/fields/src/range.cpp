#include "crane/fields/range.hpp"

#include <cmath>
#include <sstream>

namespace crane::fields {
namespace {

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  // A NaN bound permits every value; the check of the bound reports it.
  const bool too_low = low_included ? value < low : value <= low;
  const bool too_high = high_included ? value > high : value >= high;
  return !too_low && !too_high;
}

std::string Range::interval() const {
  const bool bounded_below = low > -kInfinity;
  const bool bounded_above = high < kInfinity;
  if (bounded_below && bounded_above)
    return (low_included ? '[' : '(') + shown(low) + ", " + shown(high) + (high_included ? ']' : ')');
  if (bounded_below) return (low_included ? ">= " : "> ") + shown(low);
  if (bounded_above) return (high_included ? "<= " : "< ") + shown(high);
  return {};
}

std::string Range::rule() const {
  if (low > -kInfinity && high < kInfinity) return "must be in " + interval();
  const auto bounds = interval();
  return bounds.empty() ? "must be finite" : "must be finite and " + bounds;
}

std::string complaint(const std::string& name, double value, const std::string& rule) {
  return name + " = " + shown(value) + ": " + rule;
}

}  // namespace crane::fields
