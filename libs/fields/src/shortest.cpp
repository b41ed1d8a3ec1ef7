#include "crane/fields/shortest.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace crane::fields {

std::string shortest(double value) {
  if (std::isnan(value)) return "nan";  // to_chars would write "-nan" for some NaN
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace crane::fields
