#pragma once
/// Variants are changes of a rig for the comparison of controllers. Variants of cable and load change only
/// the simulated crane, not the measurements and parameters of the controllers.
#include <string>
#include <string_view>
#include <vector>

#include "crane/configuration/rig.hpp"

namespace crane::experiment {

struct Variant {
  std::string_view name;
  std::string_view summary;
  void (*change)(configuration::Rig& rig_at_start);  ///< changes the result of with_start_of()
};

/// All variants: first the variants of a comparison, then the variants of single figures.
[[nodiscard]] const std::vector<Variant>& variants();
/// Variants of a comparison without the option --variants.
[[nodiscard]] std::vector<std::string> default_variants();

/// @param names  one or several names joined by '+', applied from left to right:
///   "slow_reference+no_compensation"
/// @return one line per unknown name, with the list of known names
[[nodiscard]] std::vector<std::string> variant_problems(const std::string& names);
/// @param names  as in variant_problems(); empty: no change. @throws configuration::ConfigurationError for an
///   unknown name
[[nodiscard]] configuration::Rig changed_by(configuration::Rig started, const std::string& names);

}  // namespace crane::experiment
