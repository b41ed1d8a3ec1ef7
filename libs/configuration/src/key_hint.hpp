#pragma once
/// Suggests a known key for an unknown key.
#include <set>
#include <string>
#include <string_view>

namespace crane::configuration {

struct KeyHint {
  /// "unknown key; did you mean load_mass_kg?", "unit must be rad: slew_angle_rad"
  std::string rule = "unknown key";
  std::string meant;  ///< the most similar known key; empty: no known key is similar
};

[[nodiscard]] KeyHint key_hint(std::string_view unknown, const std::set<std::string, std::less<>>& known);

}  // namespace crane::configuration
