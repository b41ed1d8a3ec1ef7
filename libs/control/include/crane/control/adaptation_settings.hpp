#pragma once
/// Settings of the online adaptation: [adaptation] of a rig file.
#include <array>

#include "crane/fields/field.hpp"

namespace crane::control {

struct AdaptationSettings {
  bool enabled = false;
  double friction_share = 0.5;  ///< largest relative change of Coulomb and break-away levels, [0, 0.9]
  double viscous_share = 1.0;   ///< largest relative change of the viscous coefficients, [0, 1]

  bool operator==(const AdaptationSettings&) const = default;
};

// At most 0.9: each level stays positive, at least a tenth of that of the rig file.
inline constexpr std::array<fields::Field<AdaptationSettings>, 3> kAdaptationFields{{
    {.key = "enabled",
     .member = &AdaptationSettings::enabled,
     .meaning =
         "true: the friction compensation learns its levels while the crane moves, and `crane/adaptation` "
         "shows them; false: it uses those of `[controller.friction]`"},
    {.key = "friction_share",
     .member = &AdaptationSettings::friction_share,
     .range = fields::Range::closed(0, 0.9),
     .meaning = "the Coulomb and break-away levels stay within 1 ± this share of `[controller.friction]`"},
    {.key = "viscous_share",
     .member = &AdaptationSettings::viscous_share,
     .range = fields::Range::closed(0, 1),
     .meaning = "the viscous coefficients stay within 1 ± this share of `[controller.friction]`"},
}};

}  // namespace crane::control
