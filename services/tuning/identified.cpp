#include "tuning/identified.hpp"

#include <algorithm>

#include "crane/plant/coordinates.hpp"
#include "crane/plant/term.hpp"
#include "crane/recording/csv.hpp"

namespace crane::tuning {

std::vector<NamedValue> named_values(const Identified& identified) {
  std::vector<NamedValue> list{{"cable_length", "m", identified.cable_m},
                               {"load_mass", "kg", identified.load_mass_kg},
                               {"swing_radial.rest_angle", "rad", identified.rest_angle_rad[0]}};
  if (identified.drives[plant::kSlew])
    list.push_back({"swing_tangential.rest_angle", "rad", identified.rest_angle_rad[1]});
  if (const auto& second = identified.second_mode) {
    list.push_back({"double_pendulum.lower_share", "1", second->lower_share});
    list.push_back({"double_pendulum.lower_length", "m", second->lower_length_m});
    list.push_back({"double_pendulum.hook_raised", "m", second->hook_raised_m});
  }
  for (const std::size_t axis : {plant::kTrolley, plant::kSlew}) {
    if (!identified.drives[axis]) continue;
    const auto& drive = *identified.drives[axis];
    const std::string name = std::string{plant::kCoordinates[axis].name} + '.',
                      unit = plant::kCoordinates[axis].unit;
    list.push_back({name + "gain", unit + "/s² per V", drive.gain});
    list.push_back({name + "coulomb_positive", "V", drive.coulomb_positive_v});
    list.push_back({name + "coulomb_negative", "V", drive.coulomb_negative_v});
    list.push_back({name + "viscous_positive", "V s/" + unit, drive.viscous_positive_vspm});
    list.push_back({name + "viscous_negative", "V s/" + unit, drive.viscous_negative_vspm});
    list.push_back({name + "delay", "s", drive.delay_s});
  }
  return list;
}

double largest_lower_share() {
  const auto& parameters = plant::find_term("double_pendulum")->parameters;
  return std::ranges::find(parameters, "lower_share", &plant::TermParameter::name)->high;
}

plant::TermSetting double_pendulum_term(double lower_share, double lower_length_m, double hook_raised_m) {
  return {
      "double_pendulum",
      "",
      {{"lower_share", lower_share}, {"lower_length_m", lower_length_m}, {"hook_raised_m", hook_raised_m}}};
}

bool is_identified_term(const plant::TermSetting& term) {
  constexpr std::array kTerms{"drive_friction", "coulomb_friction", "viscous_friction", "direction_asymmetry",
                              "motor_gain",     "command_delay",    "double_pendulum",  "cable_length",
                              "payload_mass",   "swing_offset"};
  return term.axis != "hoist" && std::ranges::find(kTerms, term.name) != kTerms.end();
}

configuration::Rig with_identified(configuration::Rig rig, const Identified& identified) {
  std::erase_if(rig.terms, is_identified_term);
  rig.start.position[plant::kHoist] = identified.cable_m.value;
  rig.start.cable_length_offset_m = 0;
  rig.design.cable_length_m = identified.cable_m.value;
  rig.encoders[plant::kSwingRadial].rest_angle_rad = identified.rest_angle_rad[0].value;
  rig.encoders[plant::kSwingTangential].rest_angle_rad = identified.rest_angle_rad[1].value;
  rig.plant.load_mass_kg = identified.load_mass_kg.value;
  if (const auto& second = identified.second_mode)
    rig.terms.push_back(double_pendulum_term(second->lower_share.value, second->lower_length_m.value,
                                             second->hook_raised_m.value));
  for (const std::size_t axis : {plant::kTrolley, plant::kSlew}) {
    if (!identified.drives[axis]) continue;
    const auto& drive = *identified.drives[axis];
    (axis == plant::kTrolley ? rig.plant.trolley_gain_mps2pv : rig.plant.slew_gain_radps2pv) =
        drive.gain.value;
    const std::string name = plant::kCoordinates[axis].name;
    rig.terms.push_back({"drive_friction",
                         name,
                         {{"coulomb_positive_v", drive.coulomb_positive_v.value},
                          {"coulomb_negative_v", drive.coulomb_negative_v.value},
                          {"viscous_positive_vspm", drive.viscous_positive_vspm.value},
                          {"viscous_negative_vspm", drive.viscous_negative_vspm.value}}});
    if (drive.delay_s.value > 0)
      rig.terms.push_back({"command_delay", name, {{"delay_s", drive.delay_s.value}}});
    auto& friction = rig.design.friction[axis];
    friction.coulomb_positive_v = friction.stiction_positive_v = drive.coulomb_positive_v.value;
    friction.coulomb_negative_v = friction.stiction_negative_v = drive.coulomb_negative_v.value;
    friction.viscous_positive_vspm = drive.viscous_positive_vspm.value;
    friction.viscous_negative_vspm = drive.viscous_negative_vspm.value;
    friction.factor = 1;
  }
  rig.design.crane = rig.plant;
  return rig;
}

std::vector<std::string> outside(const Identified& identified, const configuration::Rig& rig,
                                 const Priors& priors) {
  std::vector<std::string> lines;
  constexpr double kErrors = 3;  // permitted excess over a bound, in standard errors
  const auto check = [&](const std::string& name, const Value& value, double low, double high) {
    const double margin = kErrors * value.standard_error + 0.02 * (high - low);
    if (value.value < low - margin || value.value > high + margin)
      lines.push_back(name + " = " + recording::shortest(value.value) + ": outside the priors [" +
                      recording::shortest(low) + ", " + recording::shortest(high) + "]");
  };
  check("cable_length", identified.cable_m, priors.cable_low_m, priors.cable_high_m);
  check("load_mass", identified.load_mass_kg, priors.payload_low * rig.plant.load_mass_kg,
        priors.payload_high * rig.plant.load_mass_kg);
  for (const auto& angle : identified.rest_angle_rad)
    check("rest_angle", angle, -priors.rest_angle_rad, priors.rest_angle_rad);
  for (const std::size_t axis : {plant::kTrolley, plant::kSlew}) {
    if (!identified.drives[axis]) continue;
    const auto& drive = *identified.drives[axis];
    const std::string name = std::string{plant::kCoordinates[axis].name} + '.';
    const double given =
        axis == plant::kTrolley ? rig.plant.trolley_gain_mps2pv : rig.plant.slew_gain_radps2pv;
    check(name + "gain", drive.gain, (1 - priors.gain_share) * given, (1 + priors.gain_share) * given);
    const double friction_v = priors.friction_share * rig.drives[axis].volt_limit_v;
    check(name + "coulomb_positive", drive.coulomb_positive_v, 0, friction_v);
    check(name + "coulomb_negative", drive.coulomb_negative_v, 0, friction_v);
    check(name + "delay", drive.delay_s, 0, priors.delay_periods * rig.period_s);
  }
  return lines;
}

}  // namespace crane::tuning
