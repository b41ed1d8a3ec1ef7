#include "score/judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace crane::diagnosis::score {
namespace {

constexpr std::array kNames{"right",  "among",  "group", "beside",     "partly",
                            "unsure", "missed", "wrong", "wrong_among"};

bool fits(const Cause& cause, const HiddenEffect& hidden) {
  return cause.name == hidden.name &&
         (cause.axis.empty() || hidden.axis.empty() || cause.axis == hidden.axis);
}

Judged judge_named(const Diagnosis& found, const std::vector<HiddenEffect>& hidden) {
  std::size_t there = 0, alike = 0;
  for (const HiddenEffect& effect : hidden) {
    const auto any = [&](auto&& is_it) {
      return std::any_of(found.causes.begin(), found.causes.end(), is_it);
    };
    if (any([&](const Cause& cause) { return fits(cause, effect); }))
      ++there;
    else if (any([&](const Cause& cause) { return confounded(cause.name, effect.name); }))
      ++alike;
  }
  if (there == hidden.size()) return found.causes.size() == hidden.size() ? Judged::right : Judged::beside;
  const bool too_many = found.causes.size() > hidden.size();
  if (there + alike == hidden.size() && !too_many) return Judged::group;
  return there > 0 || (alike > 0 && !too_many) ? Judged::partly : Judged::wrong;
}

// Conventions of the truth: an asymmetry is the whole difference between the directions; a positive tilt
// lowers the tip of the jib; swing sensors are rotated in the opposite direction.
constexpr std::array kShared{
    SharedParameter{"coulomb_friction", "coulomb_v", "level_v"},
    SharedParameter{"viscous_friction", "viscous_vspm", "vspm"},
    SharedParameter{"direction_asymmetry", "coulomb_difference_v", "coulomb_v", 0.5},
    SharedParameter{"direction_asymmetry", "viscous_difference_vspm", "viscous_vspm", 0.5},
    SharedParameter{"motor_gain", "factor", "factor"},
    SharedParameter{"command_offset", "offset_v", "offset_v"},
    SharedParameter{"command_dead_zone", "width_v", "width_v"},
    SharedParameter{"command_delay", "delay_s", "delay_s"},
    SharedParameter{"torque_ripple", "amplitude_v", "amplitude_v"},
    SharedParameter{"torque_ripple", "wavelength", "period"},
    SharedParameter{"backlash", "gap", "gap"},
    SharedParameter{"payload_mass", "mass_change_kg", "delta_kg"},
    SharedParameter{"cable_length", "length_change_m", "delta_m"},
    SharedParameter{"load_linear_drag", "coefficient_nspm", "coefficient_nspm"},
    SharedParameter{"load_quadratic_drag", "coefficient_ns2pm2", "coefficient_ns2pm2"},
    SharedParameter{"steady_wind", "force_n", "force_n"},
    SharedParameter{"steady_wind", "direction_rad", "direction_rad"},
    SharedParameter{"swing_pivot_friction", "coulomb_nm", "coulomb_nm"},
    SharedParameter{"swing_pivot_friction", "viscous_nmsprad", "viscous_nmsprad"},
    SharedParameter{"jib_tilt", "tilt_rad", "angle_rad", -1},
    SharedParameter{"double_pendulum", "sling_m", "lower_length_m"},
    SharedParameter{"swing_offset", "offset_rad", "offset_rad"},
    SharedParameter{"swing_misalignment", "angle_rad", "angle_rad", -1},
    SharedParameter{"swing_scale", "factor", "factor"},
    SharedParameter{"position_scale", "factor", "factor"},
    SharedParameter{"swing_delay", "delay_s", "delay_s"},
    SharedParameter{"swing_moving_average", "window_s", "window_s"},
};

}  // namespace

const char* name_of(Judged judged) { return kNames[static_cast<std::size_t>(judged)]; }

std::span<const SharedParameter> shared_parameters() { return kShared; }

const std::vector<ConfoundedGroup>& confounded_groups() {
  static const std::vector<ConfoundedGroup> kGroups{
      {{"command_delay", "actuator_lag"}, "two frequencies"},
      {{"swing_delay", "swing_moving_average"}, "two cable lengths"},
      {{"direction_asymmetry", "jib_tilt", "command_offset"}, "break-away, payload"},
      {{"steady_wind", "swing_offset", "jib_tilt"}, "half a turn (wind), a known added mass (tilt)"},
      {{"stribeck_friction", "position_dependent_friction"}, "the same places at several speeds"},
      {{"motor_gain", "drive_inertia", "position_scale"}, "a load (scale), friction (inertia)"},
      {{"cable_elasticity", "cable_length"}, "no experiment: the bounce of the load is not measured"}};
  return kGroups;
}

bool confounded(const std::string& a, const std::string& b) {
  const auto holds = [](const ConfoundedGroup& group, const std::string& name) {
    return std::find(group.causes.begin(), group.causes.end(), name) != group.causes.end();
  };
  return std::any_of(confounded_groups().begin(), confounded_groups().end(),
                     [&](const ConfoundedGroup& group) { return holds(group, a) && holds(group, b); });
}

Judged judge(const Diagnosis& found, const std::vector<HiddenEffect>& answer) {
  std::vector<HiddenEffect> hidden;
  std::copy_if(answer.begin(), answer.end(), std::back_inserter(hidden),
               [](const HiddenEffect& effect) { return effect.in_library; });
  switch (found.verdict) {
    case Verdict::none:
      return answer.empty() ? Judged::right : Judged::missed;
    case Verdict::unknown:
      return answer.size() > hidden.size() ? Judged::right : answer.empty() ? Judged::wrong : Judged::unsure;
    case Verdict::ambiguous: {
      const bool there = std::any_of(hidden.begin(), hidden.end(), [&](const HiddenEffect& effect) {
        const auto& rivals = found.ambiguous_with;
        return std::find(rivals.begin(), rivals.end(), effect.name) != rivals.end() ||
               std::any_of(found.causes.begin(), found.causes.end(),
                           [&](const Cause& cause) { return fits(cause, effect); });
      });
      return there ? Judged::among : Judged::wrong_among;
    }
    case Verdict::named:
    case Verdict::parameter:
      break;
  }
  return hidden.empty() ? Judged::wrong : judge_named(found, hidden);
}

bool Compared::inside() const { return std::abs(estimate - truth) <= 1.96 * std_dev; }
bool Compared::within_5pc() const { return std::abs(estimate - truth) <= 0.05 * std::abs(truth); }

std::vector<Compared> compared(const Diagnosis& found, const std::vector<HiddenEffect>& answer) {
  std::vector<Compared> all;
  for (const HiddenEffect& hidden : answer)
    for (const Cause& cause : found.causes) {
      if (!fits(cause, hidden)) continue;
      for (const SharedParameter& shared : kShared) {
        const auto truth = hidden.parameters.find(std::string{shared.truth});
        if (shared.cause != cause.name || truth == hidden.parameters.end()) continue;
        for (const Estimate& e : cause.parameters)
          if (e.name == shared.library)
            all.push_back({cause.name, e.name, shared.factor * truth->second, e.value, e.std_dev});
      }
    }
  return all;
}

}  // namespace crane::diagnosis::score
