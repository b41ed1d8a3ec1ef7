#include "crane/experiment/variant.hpp"

#include <algorithm>
#include <numbers>

#include "crane/plant/term.hpp"

namespace crane::experiment {
namespace {

using configuration::Rig;

bool has_friction(const Rig& rig, std::size_t axis) {
  return std::any_of(rig.terms.begin(), rig.terms.end(), [axis](const plant::TermSetting& term) {
    const plant::TermKind* kind = plant::find_term(term.name);
    return kind != nullptr && kind->acts_on == plant::ActsOn::drive && plant::drive_axis(term.axis) == axis;
  });
}

/// Sets the compensated share of every drive with friction.
void compensate(Rig& rig, double factor) {
  for (std::size_t axis = 0; axis < plant::kAxes; ++axis)
    rig.design.friction[axis].factor = has_friction(rig, axis) ? factor : 0;
}

/// @param ratio  true / measured cable length, for example with slings of another length than at the zeroing
///   of the encoder. The gains depend on the measured length, the swing on the true length.
void stretch_cable(Rig& rig, double ratio) {
  rig.start.cable_length_offset_m = (ratio - 1) * rig.start.position[plant::kHoist];
}

void know_cable(Rig& rig) {
  rig.start.position[plant::kHoist] += rig.start.cable_length_offset_m;
  rig.start.cable_length_offset_m = 0;
}

/// Stretches the references by `ratio` in time; their path does not change.
void slow_down(Rig& rig, double ratio) {
  for (auto& drive : rig.drives) {
    drive.reference_speed /= ratio;
    drive.reference_acceleration /= ratio * ratio;
    drive.reference_jerk /= ratio * ratio * ratio;
  }
}

void remove_filters(Rig& rig) {
  rig.sensing.swing_filter_ratio = 0;
  rig.sensing.filter_speed.fill(false);
}

template <int tenths>
void forward_gain(Rig& rig) {
  rig.design.full_state_forward_gain_vpm = tenths / 10.0;
}

/// Scales the true friction of every drive; the compensation keeps the values of the rig file.
void scale_friction(Rig& rig, double ratio) {
  for (auto& term : rig.terms) {
    const plant::TermKind* kind = plant::find_term(term.name);
    if (kind == nullptr || kind->acts_on != plant::ActsOn::drive) continue;
    for (auto& [name, value] : term.parameters)
      if (name.starts_with("coulomb_") || name.starts_with("viscous_") || name.starts_with("excess_"))
        value *= ratio;
  }
}

/// Moderate breeze with a turbulence of a quarter of its speed. The drag is that of a cube of 0.15 m:
/// d = rho c_w A / 2 = 1.2 kg/m3 * 1.05 * 0.0225 m2 / 2. Wind and three standard deviations of the gusts
/// accelerate a load of 2 kg by d (V + 3 sigma)^2 / m = 0.8 m/s2, which the check of the swing encoders must
/// tolerate.
void blow(Rig& rig, double direction_rad) {
  rig.clearance.wind_mps2 = 0.8;
  rig.terms.push_back({"wind_gust",
                       "",
                       {{"coefficient_ns2pm2", 0.0142},
                        {"mean_mps", 6},
                        {"scatter_mps", 1.5},
                        {"direction_rad", direction_rad}}});
}

constexpr std::size_t kDefaultVariants = 8;
const std::vector<Variant> kVariants{
    {"ideal", "plant without friction and other terms, no compensation",
     [](Rig& rig) {
       rig.terms.clear();
       compensate(rig, 0);
     }},
    {"exact_compensation", "100 % of the nominal friction is compensated",
     [](Rig& rig) { compensate(rig, 1); }},
    {"no_compensation", "the friction is not compensated", [](Rig& rig) { compensate(rig, 0); }},
    {"under_compensation", "80 % of the nominal friction is compensated",
     [](Rig& rig) { compensate(rig, 0.8); }},
    {"short_cable", "the true cable is 50 % shorter than measured",
     [](Rig& rig) { stretch_cable(rig, 0.5); }},
    {"long_cable", "the true cable is 50 % longer than measured", [](Rig& rig) { stretch_cable(rig, 1.5); }},
    {"light_load", "the true load is 50 % lighter than in the rig file",
     [](Rig& rig) { rig.plant.load_mass_kg *= 0.5; }},
    {"heavy_load", "the true load is 50 % heavier than in the rig file",
     [](Rig& rig) { rig.plant.load_mass_kg *= 1.5; }},
    {"cable_minus_20", "the true cable is 20 % shorter than measured",
     [](Rig& rig) { stretch_cable(rig, 0.8); }},
    {"cable_plus_20", "the true cable is 20 % longer than measured",
     [](Rig& rig) { stretch_cable(rig, 1.2); }},
    {"friction_minus_20", "the true friction of the drives is 20 % lower than compensated",
     [](Rig& rig) { scale_friction(rig, 0.8); }},
    {"friction_plus_20", "the true friction of the drives is 20 % higher than compensated",
     [](Rig& rig) { scale_friction(rig, 1.2); }},
    {"gusts_along", "a wind of 6 m/s with gusts of 1.5 m/s along the jib at slew angle 0",
     [](Rig& rig) { blow(rig, 0); }},
    {"gusts_across", "the same wind, across the jib at slew angle 0",
     [](Rig& rig) { blow(rig, std::numbers::pi / 2); }},
    {"as_is", "the rig file without changes", [](Rig&) {}},
    {"known_load", "the controllers use the true load mass",
     [](Rig& rig) { rig.design.crane.load_mass_kg = rig.plant.load_mass_kg; }},
    {"known_cable", "the hoist encoder measures the true cable length", know_cable},
    {"nominal_cable", "the true cable length is the measured one",
     [](Rig& rig) { rig.start.cable_length_offset_m = 0; }},
    {"unfiltered", "no low-pass filter before the differentiators", remove_filters},
    {"observer", "the laws use the pendulum observer instead of filters and differentiators",
     [](Rig& rig) { rig.design.swing_observer = true; }},
    {"filtered_angle", "the swing angles pass the low-pass filter, too",
     [](Rig& rig) { rig.sensing.filter_swing_angle = true; }},
    // (4.22) of H. M. Omar, Control of Gantry and Tower Cranes
    {"slow_reference", "references take twice the time, (4.22)", [](Rig& rig) { slow_down(rig, 2); }},
    {"full_gain_0.4", "full state feedback with K = 0.4", forward_gain<4>},
    {"full_gain_2", "full state feedback with K = 2", forward_gain<20>},
    {"full_gain_4", "full state feedback with K = 4", forward_gain<40>},
    {"full_gain_8", "full state feedback with K = 8", forward_gain<80>},
    {"full_gain_12", "full state feedback with K = 12", forward_gain<120>},
};

const Variant* find_variant(std::string_view name) {
  const auto found =
      std::find_if(kVariants.begin(), kVariants.end(), [&](const Variant& v) { return v.name == name; });
  return found == kVariants.end() ? nullptr : &*found;
}

std::vector<std::string> parts_of(const std::string& names) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= names.size();) {
    const std::size_t end = std::min(names.find('+', begin), names.size());
    parts.push_back(names.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

}  // namespace

const std::vector<Variant>& variants() { return kVariants; }

std::vector<std::string> default_variants() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kDefaultVariants; ++i) names.emplace_back(kVariants[i].name);
  return names;
}

std::vector<std::string> variant_problems(const std::string& names) {
  std::string known;
  for (const Variant& variant : kVariants) known += (known.empty() ? "" : ", ") + std::string{variant.name};
  std::vector<std::string> problems;
  for (const std::string& name : parts_of(names))
    if (find_variant(name) == nullptr)
      problems.push_back("variant \"" + name + "\": must be one of " + known);
  return problems;
}

Rig changed_by(Rig started, const std::string& names) {
  if (names.empty()) return started;
  if (auto problems = variant_problems(names); !problems.empty())
    throw configuration::ConfigurationError(std::move(problems));
  for (const std::string& name : parts_of(names)) find_variant(name)->change(started);
  return started;
}

}  // namespace crane::experiment
