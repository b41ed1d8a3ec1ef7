#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "candidates/candidate.hpp"
#include "crane/plant/term.hpp"

namespace crane::innovations {
namespace {

using Setting = std::map<std::string, double>;

/// How one parameter of a term follows from a free one.
struct OneToOne {
  const char *term, *parameter;
  std::size_t place;  ///< in theta
  double add;         ///< 1 where the free one is factor - 1
};
constexpr std::array kOneToOne{
    OneToOne{"coulomb_friction", "level_v", 0, 0},
    OneToOne{"viscous_friction", "vspm", 0, 0},
    OneToOne{"direction_asymmetry", "coulomb_v", 0, 0},
    OneToOne{"direction_asymmetry", "viscous_vspm", 1, 0},
    OneToOne{"stribeck_friction", "excess_v", 0, 0},
    OneToOne{"stribeck_friction", "decay_speed", 1, 0},
    OneToOne{"position_dependent_friction", "amplitude_v", 0, 0},
    OneToOne{"position_dependent_friction", "tight_at", 1, 0},
    OneToOne{"position_dependent_friction", "wavelength", 2, 0},
    OneToOne{"motor_gain", "factor", 0, 1},
    OneToOne{"command_offset", "offset_v", 0, 0},
    OneToOne{"command_dead_zone", "width_v", 0, 0},
    OneToOne{"command_delay", "delay_s", 0, 0},
    OneToOne{"actuator_lag", "time_constant_s", 0, 0},
    OneToOne{"actuator_lag", "second_s", 1, 0},
    OneToOne{"load_dependent_friction", "share", 0, 0},
    OneToOne{"position_scale", "factor", 0, 1},
    OneToOne{"payload_mass", "delta_kg", 0, 0},
    OneToOne{"cable_length", "delta_m", 0, 0},
    OneToOne{"load_linear_drag", "coefficient_nspm", 0, 0},
    OneToOne{"load_quadratic_drag", "coefficient_ns2pm2", 0, 0},
    OneToOne{"swing_pivot_friction", "coulomb_nm", 0, 0},
    OneToOne{"swing_pivot_friction", "viscous_nmsprad", 1, 0},
    OneToOne{"jib_tilt", "angle_rad", 0, 0},
    OneToOne{"double_pendulum", "lower_share", 0, 0},
    OneToOne{"double_pendulum", "lower_length_m", 1, 0},
    OneToOne{"double_pendulum", "hook_raised_m", 2, 0},
    OneToOne{"swing_offset", "offset_rad", 0, 0},
    OneToOne{"swing_scale", "factor", 0, 1},
    OneToOne{"swing_misalignment", "angle_rad", 0, 0},
    OneToOne{"swing_delay", "delay_s", 0, 0},
    OneToOne{"swing_moving_average", "window_s", 0, 0},
};

/// The rig file's own amount is in it already. A factor multiplies the base's.
double beyond_base(const Problem& problem, const Values& values, Index i, double add) {
  if (add == 1) return (1 + values[i]) / (1 + problem.base[i]) - 1;
  const bool shape = problem.table[i].null != 0 && problem.base[i] == problem.table[i].null;
  return shape ? values[i] : values[i] - problem.base[i];
}

Setting parameters_of(const Candidate& c, const Problem& problem, const Values& v) {
  Setting setting;
  for (const OneToOne& one : kOneToOne)
    if (c.name == one.term)
      setting[one.parameter] = one.add + beyond_base(problem, v, c.theta[one.place], one.add);
  const auto wave = [&](double period) {
    setting["amplitude_v"] = std::hypot(v[c.theta[0]], v[c.theta[1]]);
    setting["phase_rad"] = std::atan2(v[c.theta[1]], v[c.theta[0]]);
    setting["period"] = period;
  };
  if (c.name == "torque_ripple") wave(v[c.theta[2]]);
  if (c.name == "torque_of_turn") wave(2 * std::numbers::pi);
  if (c.name == "steady_wind") {
    const double across = c.theta.size() > 1 ? v[c.theta[1]] : 0;
    setting["force_n"] = std::hypot(v[c.theta[0]], across);
    setting["direction_rad"] = std::atan2(across, v[c.theta[0]]);
  }
  return setting;
}

/// A torque of one turn is a ripple whose period is the turn.
std::string term_name(const Candidate& c) { return c.name == "torque_of_turn" ? "torque_ripple" : c.name; }

std::string unit_of(const Candidate& c, const std::string& parameter) {
  if (const plant::TermKind* kind = plant::find_term(term_name(c)))
    for (const auto& p : kind->parameters)
      if (p.name == parameter) return std::string{p.unit};
  return "1";
}

}  // namespace

plant::TermSetting setting_of(const Candidate& c, const Problem& problem, const Values& values) {
  return {term_name(c), c.axis, parameters_of(c, problem, values)};
}

std::vector<Estimate> estimates_of(const Candidate& c, const Problem& problem, const Values& values,
                                   const Eigen::MatrixXd& covariance) {
  const Setting at = parameters_of(c, problem, values);
  std::vector<Estimate> estimates;
  for (const auto& [name, value] : at) {
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(c.theta.size()));
    for (std::size_t i = 0; i < c.theta.size(); ++i) {
      Values moved = values;
      const double step = 1e-4 * problem.table[c.theta[i]].scale;
      moved[c.theta[i]] += step;
      slope[static_cast<Eigen::Index>(i)] = (parameters_of(c, problem, moved).at(name) - value) / step;
    }
    const double variance = covariance.size() > 0 ? slope.dot(covariance * slope) : 0;
    estimates.push_back({name, unit_of(c, name), value, std::sqrt(std::max(0.0, variance))});
  }
  return estimates;
}

}  // namespace crane::innovations
