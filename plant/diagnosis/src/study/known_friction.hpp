#pragma once
/// Friction of a drive in the rig file.
#include <algorithm>
#include <string>

#include "crane/configuration/rig.hpp"

namespace crane::diagnosis {

/// Term drive_friction of an axis; the smaller value of both directions.
struct KnownFriction {
  double least_coulomb_v = 0;  ///< V
  double least_viscous = 0;    ///< V s/m or V s/rad
  bool present = false;
};

/// @param axis "trolley" or "slew"
[[nodiscard]] inline KnownFriction known_friction(const configuration::Rig& rig, const std::string& axis) {
  KnownFriction known;
  for (const plant::TermSetting& term : rig.terms) {
    if (term.name != "drive_friction" || term.axis != axis) continue;
    const auto value = [&](const char* name) {
      const auto found = term.parameters.find(name);
      return found == term.parameters.end() ? 0.0 : found->second;
    };
    known = {std::min(value("coulomb_positive_v"), value("coulomb_negative_v")),
             std::min(value("viscous_positive_vspm"), value("viscous_negative_vspm")), true};
  }
  return known;
}

}  // namespace crane::diagnosis
