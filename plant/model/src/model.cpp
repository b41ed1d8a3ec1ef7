#include "crane/plant/model.hpp"

#include <cmath>
#include <stdexcept>

#include "tilted_jib.hpp"

namespace crane::plant {
namespace {

void throw_if_any(const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  throw std::invalid_argument(text);
}

}  // namespace

Model::Model(const Parameters& parameters, const std::vector<TermSetting>& terms, double period_s)
    : parameters_(parameters), period_s_(period_s) {
  std::vector<std::string> found = parameters.problems();
  const std::vector<std::string> of_terms = problems(terms);
  found.insert(found.end(), of_terms.begin(), of_terms.end());
  throw_if_any(found);
  for (const TermSetting& setting : terms) {
    std::unique_ptr<Term> term = make_term(setting);
    switch (find_term(setting.name)->acts_on) {
      case ActsOn::parameters:
        term->change_parameters(parameters_);
        break;
      case ActsOn::command:
        command_terms_.push_back(std::move(term));
        break;
      case ActsOn::drive:
        has_gear_friction_[drive_axis(setting.axis)] |= term->has_gear_friction();
        drive_terms_[drive_axis(setting.axis)].push_back(std::move(term));
        break;
      case ActsOn::load:
        load_terms_.push_back(std::move(term));
        break;
      case ActsOn::structure:
        add_structure(std::move(term));
        break;
      case ActsOn::sensor:
        sensor_terms_.push_back(std::move(term));
        break;
    }
  }
  throw_if_any(parameters_.problems());
}

void Model::add_structure(std::unique_ptr<Term> term) {
  const std::size_t count = term->inner_coordinates();
  if (inner_coordinates_ + count > kMostInner)
    throw_if_any({"terms: more than " + std::to_string(kMostInner) + " inner coordinates in all"});
  term->change_parameters(parameters_);
  const Displacement rest = term->rest_displacement(parameters_);
  rest_displacement_.trolley_m += rest.trolley_m;
  rest_displacement_.slew_rad += rest.slew_rad;
  rest_displacement_.cable_m += rest.cable_m;
  structure_terms_.push_back({std::move(term), inner_coordinates_});
  inner_coordinates_ += count;
}

std::vector<std::size_t> Model::ringing_coordinates() const {
  std::vector<std::size_t> ringing;
  for (const auto& [term, first] : structure_terms_)
    for (std::size_t i = 0; term->rings() && i < term->inner_coordinates(); ++i) ringing.push_back(first + i);
  return ringing;
}

void Model::begin_tick() noexcept {
  for (const auto& term : load_terms_) term->begin_tick(period_s_);
}

PerAxis Model::drive_voltage(const PerAxis& command_v) noexcept {
  PerAxis drive_v = command_v;
  for (const auto& term : command_terms_) term->change_command(drive_v, period_s_);
  return drive_v;
}

PerAxis Model::friction_v(const State& state, const PerAxis& drive_v) const noexcept {
  PerAxis sum{};
  for (const Axis axis : {kTrolley, kSlew, kHoist}) sum[axis] = friction_v(state, drive_v[axis], axis);
  return sum;
}

PerAxis Model::free_drives_friction_v(const State& state, const Actuation& actuation) const noexcept {
  PerAxis sum{};
  for (const Axis axis : {kTrolley, kSlew, kHoist})
    if (!actuation.locks.axis[axis]) sum[axis] = friction_v(state, actuation.drive_v[axis], axis);
  return sum;
}

double Model::friction_v(const State& state, double drive_v, Axis axis) const noexcept {
  const DriveMotion drive(position(state, axis), speed(state, axis));
  double sum_v = 0;
  for (const auto& term : drive_terms_[axis]) term->add_friction(drive, sum_v);
  if (has_gear_friction_[axis]) {
    double carried_v = drive_v;
    for (const auto& term : drive_terms_[axis]) carried_v -= term->position_force_v(drive.position);
    for (const auto& term : drive_terms_[axis]) term->add_gear_friction(drive, std::abs(carried_v), sum_v);
  }
  if (structure_terms_.empty()) return sum_v;
  PerAxis relieved{};
  relieved[axis] = sum_v;
  for (const auto& structure : structure_terms_)
    structure.term->relieve_friction(parameters_, state, relieved);
  return relieved[axis];
}

std::array<PerAxis, kAxes> Model::friction_response(const State& state, const Locks& locks,
                                                    const InnerState& inner) const noexcept {
  const Parameters& p = parameters_;
  const DriveResponse r =
      drive_response(p, structure_terms_.empty() ? state : displaced(state, inner), locks);
  const double force_n = p.trolley_inertia_kg * p.trolley_gain_mps2pv,
               torque_nm = p.jib_inertia_kgm2 * p.slew_gain_radps2pv;
  std::array<PerAxis, kAxes> taken{};
  taken[kTrolley] = {r.trolley_mps2_pn * force_n, r.coupling * torque_nm, 0};
  taken[kSlew] = {r.coupling * force_n, r.slew_radps2_pnm * torque_nm, 0};
  return taken;
}

State Model::displaced(const State& state, const InnerState& inner) const noexcept {
  std::array<double, kMostInner> positions{}, rates{};
  for (std::size_t i = 0; i < inner_coordinates_; ++i) {
    positions[i] = inner[i].position;
    rates[i] = inner[i].rate;
  }
  Displacement moved = rest_displacement_, moving;
  for (const auto& [term, first] : structure_terms_) {
    term->displace(&positions[first], moved);
    term->displace(&rates[first], moving);
  }
  State seen = state;
  seen.trolley_m += moved.trolley_m, seen.trolley_mps += moving.trolley_m;
  seen.slew_rad += moved.slew_rad, seen.slew_radps += moving.slew_rad;
  seen.cable_m += moved.cable_m, seen.cable_mps += moving.cable_m;
  return seen;
}

Forces Model::forces(const State& seen, const motion::Angles<double>& cable, const Actuation& actuation,
                     const PerAxis& friction) const noexcept {
  const Parameters& p = parameters_;
  const PerAxis& v = actuation.drive_v;
  Forces sum;
  sum.trolley_n = p.trolley_inertia_kg * p.trolley_gain_mps2pv * (v[kTrolley] - friction[kTrolley]) +
                  actuation.brake_effort[kTrolley];
  sum.slew_nm = p.jib_inertia_kgm2 * p.slew_gain_radps2pv * (v[kSlew] - friction[kSlew]) +
                actuation.brake_effort[kSlew];
  for (const auto& term : load_terms_) term->add_force(p, seen, cable, sum);
  return sum;
}

double Model::hoisting_mps2(const State& state, const Actuation& actuation,
                            const PerAxis& friction) const noexcept {
  const double braking_mps2 = actuation.brake_effort[kHoist];
  if (braking_mps2 != 0) return braking_mps2;
  const Parameters& p = parameters_;
  return (p.hoist_gain_mpspv * (actuation.drive_v[kHoist] - friction[kHoist]) - state.cable_mps) /
         p.hoist_lag_s;
}

ModelEquations Model::equations(const State& state, const Actuation& actuation, const PerAxis& friction,
                                const InnerState& inner) const noexcept {
  const Parameters& p = parameters_;
  const State seen = structure_terms_.empty() ? state : displaced(state, inner);
  const motion::Angles<double> angles = swing_angles(p, seen), cable = tilted::level(p, angles);
  Forces sum = forces(seen, cable, actuation, friction);
  ModelEquations result;
  for (const auto& [term, first] : structure_terms_)
    term->add_inner_motion(p, seen, cable, &inner[first], sum, &result.inner[first]);
  result.motion =
      motion_equations(p, seen, angles, sum, hoisting_mps2(state, actuation, friction), actuation.locks);
  return result;
}

void Model::add_friction(const PerAxis& friction, ModelEquations& equations) const noexcept {
  const Parameters& p = parameters_;
  equations.motion.net.trolley_n -= p.trolley_inertia_kg * p.trolley_gain_mps2pv * friction[kTrolley];
  equations.motion.net.slew_nm -= p.jib_inertia_kgm2 * p.slew_gain_radps2pv * friction[kSlew];
}

Accelerations Model::solution(const ModelEquations& equations, const Actuation& actuation,
                              InnerAccelerations& inner_accelerations) const noexcept {
  Accelerations result = plant::solution(equations.motion, actuation.locks);
  if (structure_terms_.empty()) return result;
  const auto accelerate = [&] {
    for (std::size_t i = 0; i < inner_coordinates_; ++i)
      if (!actuation.prescribed[i]) inner_accelerations[i] = equations.inner[i].acceleration(result);
  };
  accelerate();
  Displacement pushed;
  for (const auto& [term, first] : structure_terms_) term->displace(&inner_accelerations[first], pushed);
  if (pushed.trolley_m == 0 && pushed.slew_rad == 0) return result;
  const SwingResponse swing =
      swing_response(equations.motion.mass, pushed.trolley_m, pushed.slew_rad, actuation.locks);
  result.radial_radps2 += swing.radial_radps2;
  result.tangential_radps2 += swing.tangential_radps2;
  if (structure_terms_.size() > 1) accelerate();  // other terms depend on the changed swing acceleration
  return result;
}

Accelerations Model::accelerations(const State& state, const Actuation& actuation, const PerAxis& friction,
                                   const InnerState& inner,
                                   InnerAccelerations& inner_accelerations) const noexcept {
  return solution(equations(state, actuation, friction, inner), actuation, inner_accelerations);
}

void Model::correct(const State& state, const PerAxis& unexplained, const InnerState& before,
                    InnerState& inner) const noexcept {
  for (const auto& [term, first] : structure_terms_)
    term->correct(parameters_, state, unexplained, &before[first], &inner[first]);
}

Accelerations Model::accelerations(const State& state, const Actuation& actuation, const InnerState& inner,
                                   InnerAccelerations& inner_accelerations) const noexcept {
  return accelerations(state, actuation, free_drives_friction_v(state, actuation), inner,
                       inner_accelerations);
}

Accelerations Model::accelerations(const State& state, const Actuation& actuation) const noexcept {
  InnerAccelerations ignored{};
  return accelerations(state, actuation, InnerState{}, ignored);
}

bool Model::sensors_remember_motion() const noexcept {
  return std::ranges::any_of(sensor_terms_, [](const auto& term) { return term->remembers_motion(); });
}

Measurement Model::measure(const State& state) noexcept {
  Measurement measured{.trolley_m = state.trolley_m,
                       .slew_rad = state.slew_rad,
                       .cable_m = state.cable_m,
                       .radial_rad = state.radial_rad,
                       .tangential_rad = state.tangential_rad};
  for (const auto& term : sensor_terms_) term->change_measurement(measured, period_s_);
  return measured;
}

}  // namespace crane::plant
