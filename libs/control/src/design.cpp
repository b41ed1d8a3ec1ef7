#include <utility>

#include "crane/control/law.hpp"
#include "require.hpp"

namespace crane::control {

std::vector<std::string> DriveFriction::problems() const {
  constexpr double kMost = 1e3;
  Requirements rules;
  rules.in_range("viscous_positive_vspm", viscous_positive_vspm, 0, kMost);
  rules.in_range("viscous_negative_vspm", viscous_negative_vspm, 0, kMost);
  rules.in_range("coulomb_positive_v", coulomb_positive_v, 0, kMost);
  rules.in_range("coulomb_negative_v", coulomb_negative_v, 0, kMost);
  rules.in_range("stiction_positive_v", stiction_positive_v, 0, kMost);
  rules.in_range("stiction_negative_v", stiction_negative_v, 0, kMost);
  rules.above_up_to("stiction_slope_per_v", stiction_slope_per_v, 0, 1e6);
  rules.above_up_to("zero_band_mps", zero_band_mps, 0, 10);
  rules.in_range("factor", factor, 0, 1.5);
  return rules.found;
}

namespace {

constexpr std::array<const char*, kAxes> kAxisNames{"trolley", "slew", "hoist"};

void check_lengths(Requirements& rules, const Design& design) {
  const double shortest = design.shortest_cable_length_m, longest = design.longest_cable_length_m;
  rules.in_range("shortest_cable_length_m", shortest, 1e-3, 1000);
  rules.require(longest >= shortest && longest <= 1000, "longest_cable_length_m", longest,
                "must be in [shortest_cable_length_m, 1000]");
  rules.require(design.cable_length_m >= shortest && design.cable_length_m <= longest, "cable_length_m",
                design.cable_length_m, "must be in [shortest_cable_length_m, longest_cable_length_m]");
  rules.in_range("minimum_trolley_position_m", design.minimum_trolley_position_m, 1e-3, 100);
}

void check_gains(Requirements& rules, const Design& design) {
  rules.above_up_to("full_feedback_gain_pm", design.full_feedback_gain_pm, 0, 1000);
  rules.above_up_to("tracking_proportional", design.tracking_proportional, 0, 1e5);
  rules.in_range("tracking_derivative", design.tracking_derivative, 0, 1e5);
  rules.in_range("anti_swing_proportional", design.anti_swing_proportional, -1e5, 1e5);
  rules.in_range("anti_swing_derivative", design.anti_swing_derivative, -1e5, 1e5);
  rules.in_range("delayed_1_gain", design.delayed_1_gain, -1e5, 1e5);
  rules.in_range("delayed_1_delay", design.delayed_1_delay, 0, 2);
  rules.in_range("delayed_2_gain", design.delayed_2_gain, -1e3, 1e3);
  rules.in_range("delayed_2_delay", design.delayed_2_delay, 0, 2);
  rules.above_up_to("fuzzy_swing_rad", design.fuzzy_swing_rad, 0, 3.2);
  rules.above_up_to("fuzzy_swing_rate", design.fuzzy_swing_rate, 0, 1e3);
  rules.in_range("fuzzy_gain", design.fuzzy_gain, -1e5, 1e5);
  rules.require(design.fuzzy_gain != 0, "fuzzy_gain", design.fuzzy_gain, "must not be 0");
  rules.in_range("fuzzy_point_a", design.fuzzy_point_a, 0.01, 0.98);
  rules.require(design.fuzzy_point_b >= design.fuzzy_point_a + 0.01 && design.fuzzy_point_b <= 0.99,
                "fuzzy_point_b", design.fuzzy_point_b, "must be in [fuzzy_point_a + 0.01, 0.99]");
  rules.above_up_to("hoist_proportional_ps", design.hoist_proportional_ps, 0, 100);
}

/// When the compensated stiction reaches the drive's limit, no voltage is left for the control law
/// (available_control_v).
void check_friction(Requirements& rules, const Design& design, std::size_t axis, const std::string& name) {
  const DriveFriction& friction = design.friction[axis];
  for (const auto& problem : friction.problems()) rules.found.push_back("friction." + name + "." + problem);
  for (const auto& [key, volts] : {std::pair{"stiction_positive_v", friction.stiction_positive_v},
                                   std::pair{"stiction_negative_v", friction.stiction_negative_v},
                                   std::pair{"coulomb_positive_v", friction.coulomb_positive_v},
                                   std::pair{"coulomb_negative_v", friction.coulomb_negative_v}})
    rules.require(!(volts > 0 && friction.factor * volts >= design.volt_limit_v[axis]),
                  ("friction." + name + "." + key).c_str(), volts,
                  "the value times factor must be below the volt limit of the drive");
}

/// The laws divide by these parameters: a smaller value could give a result that is not finite.
void check_crane(Requirements& rules, const plant::Parameters& crane) {
  constexpr double kSmallest = 1e-6, kLeastGravity_mps2 = 1e-3;
  const auto at_least = [&rules](const char* name, double value, double least) {
    rules.require(!(value > 0 && value < least), name, value, "must be at least " + std::to_string(least));
  };
  at_least("gravity_mps2", crane.gravity_mps2, kLeastGravity_mps2);
  at_least("trolley_inertia_kg", crane.trolley_inertia_kg, kSmallest);
  at_least("jib_inertia_kgm2", crane.jib_inertia_kgm2, kSmallest);
  at_least("trolley_gain_mps2pv", crane.trolley_gain_mps2pv, kSmallest);
  at_least("slew_gain_radps2pv", crane.slew_gain_radps2pv, kSmallest);
  at_least("hoist_gain_mpspv", crane.hoist_gain_mpspv, kSmallest);
}

}  // namespace

std::vector<std::string> problems(const Design& design) {
  Requirements rules{design.crane.problems()};
  check_crane(rules, design.crane);
  rules.in_range("period_s", design.period_s, 1e-5, 1);
  check_lengths(rules, design);
  check_gains(rules, design);
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const std::string name = kAxisNames[axis];
    rules.above_up_to(("volt_limit_v." + name).c_str(), design.volt_limit_v[axis], 0, 1000);
    check_friction(rules, design, axis, name);
  }
  return rules.found;
}

}  // namespace crane::control
