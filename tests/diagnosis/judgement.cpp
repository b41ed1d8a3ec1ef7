#include "judgement.hpp"

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

/// Parameter of truth and library: library = factor * truth.
struct Shared {
  std::string_view cause, truth, library;
  double factor = 1;
};
// Conventions of the truth: asymmetry is the whole difference of the directions, the jib tilts down, swing
// sensors turn the other way.
constexpr std::array kShared{
    Shared{"coulomb_friction", "coulomb_v", "level_v"},
    Shared{"viscous_friction", "viscous_vspm", "vspm"},
    Shared{"direction_asymmetry", "coulomb_difference_v", "coulomb_v", 0.5},
    Shared{"direction_asymmetry", "viscous_difference_vspm", "viscous_vspm", 0.5},
    Shared{"motor_gain", "factor", "factor"},
    Shared{"command_offset", "offset_v", "offset_v"},
    Shared{"command_dead_zone", "width_v", "width_v"},
    Shared{"command_delay", "delay_s", "delay_s"},
    Shared{"torque_ripple", "amplitude_v", "amplitude_v"},
    Shared{"torque_ripple", "wavelength", "period"},
    Shared{"backlash", "gap", "gap"},
    Shared{"payload_mass", "mass_change_kg", "delta_kg"},
    Shared{"cable_length", "length_change_m", "delta_m"},
    Shared{"load_linear_drag", "coefficient_nspm", "coefficient_nspm"},
    Shared{"load_quadratic_drag", "coefficient_ns2pm2", "coefficient_ns2pm2"},
    Shared{"steady_wind", "force_n", "force_n"},
    Shared{"steady_wind", "direction_rad", "direction_rad"},
    Shared{"swing_pivot_friction", "coulomb_nm", "coulomb_nm"},
    Shared{"swing_pivot_friction", "viscous_nmsprad", "viscous_nmsprad"},
    Shared{"jib_tilt", "tilt_rad", "angle_rad", -1},
    Shared{"double_pendulum", "sling_m", "lower_length_m"},
    Shared{"swing_offset", "offset_rad", "offset_rad"},
    Shared{"swing_misalignment", "angle_rad", "angle_rad", -1},
    Shared{"swing_scale", "factor", "factor"},
    Shared{"position_scale", "factor", "factor"},
    Shared{"swing_delay", "delay_s", "delay_s"},
    Shared{"swing_moving_average", "window_s", "window_s"},
};

}  // namespace

const char* name_of(Judged judged) { return kNames[static_cast<std::size_t>(judged)]; }

bool confounded(const std::string& a, const std::string& b) {
  static const std::vector<std::vector<std::string>> groups{
      {"command_delay", "actuator_lag"},
      {"swing_delay", "swing_moving_average"},
      {"direction_asymmetry", "jib_tilt", "command_offset"},
      {"steady_wind", "swing_offset", "jib_tilt"},
      {"stribeck_friction", "position_dependent_friction"},
      {"motor_gain", "position_scale"},
      {"cable_elasticity", "cable_length"}};
  const auto holds = [](const std::vector<std::string>& group, const std::string& name) {
    return std::find(group.begin(), group.end(), name) != group.end();
  };
  return std::any_of(groups.begin(), groups.end(),
                     [&](const auto& group) { return holds(group, a) && holds(group, b); });
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
      for (const Shared& shared : kShared) {
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
