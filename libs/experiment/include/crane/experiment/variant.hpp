#pragma once
/// Variants: ways in which a crane departs from what its rig file says, to compare controllers under them.
/// Those of cable and load change the true crane only; what the controllers measure and believe stays.
#include <string>
#include <string_view>
#include <vector>

#include "crane/configuration/rig.hpp"

namespace crane::experiment {

struct Variant {
  std::string_view name;
  std::string_view summary;
  void (*change)(configuration::Rig& started);  ///< of the rig as its scenario starts it
};

/// Those of a comparison first, then those that single figures need.
[[nodiscard]] const std::vector<Variant>& variants();
/// What a comparison runs when nobody says otherwise.
[[nodiscard]] std::vector<std::string> default_variants();

/// Several variants joined by '+' are applied from left to right: "slow_reference+no_compensation".
/// @return one line per name that is none, with the names there are
[[nodiscard]] std::vector<std::string> variant_problems(const std::string& names);
/// @param names  empty: the rig stays as it is. @throws configuration::ConfigurationError as
/// variant_problems()
[[nodiscard]] configuration::Rig changed_by(configuration::Rig started, const std::string& names);

}  // namespace crane::experiment
