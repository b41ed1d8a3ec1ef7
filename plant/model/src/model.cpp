#include "crane/plant/model.hpp"

#include <stdexcept>

namespace crane::plant {
namespace {

void throw_if_any(const std::vector<std::string>& problems) {
  if (problems.empty()) return;
  std::string text;
  for (const std::string& problem : problems) text += (text.empty() ? "" : "\n") + problem;
  throw std::invalid_argument(text);
}

}  // namespace

Model::Model(const Parameters& parameters, const std::vector<TermSetting>& terms) : parameters_(parameters) {
  std::vector<std::string> found = parameters.problems();
  const std::vector<std::string> of_terms = problems(terms);
  found.insert(found.end(), of_terms.begin(), of_terms.end());
  throw_if_any(found);
  for (const TermSetting& setting : terms) {
    std::unique_ptr<Term> term = make_term(setting);
    switch (find_term(setting.name)->acts_on) {
      case ActsOn::command:
        command_terms_.push_back(std::move(term));
        break;
      case ActsOn::drive:
        drive_terms_.push_back(std::move(term));
        break;
      case ActsOn::load:
        load_terms_.push_back(std::move(term));
        break;
    }
  }
}

PerAxis Model::drive_voltage(const PerAxis& command_v) noexcept {
  PerAxis drive_v = command_v;
  for (const auto& term : command_terms_) term->change_command(drive_v);
  return drive_v;
}

PerAxis Model::friction_v(const State& state) const noexcept {
  PerAxis sum{};
  for (const auto& term : drive_terms_) term->add_friction(state, sum);
  return sum;
}

Accelerations Model::accelerations(const State& state, const Actuation& actuation) const noexcept {
  const Parameters& p = parameters_;
  const PerAxis friction = friction_v(state);
  const PerAxis& v = actuation.drive_v;
  Forces forces;
  forces.trolley_n = p.trolley_inertia_kg * p.trolley_gain_mps2pv * (v[kTrolley] - friction[kTrolley]) +
                     actuation.brake_effort[kTrolley];
  forces.slew_nm = p.jib_inertia_kgm2 * p.slew_gain_radps2pv * (v[kSlew] - friction[kSlew]) +
                   actuation.brake_effort[kSlew];
  for (const auto& term : load_terms_) term->add_force(p, state, forces);
  const bool braking = actuation.brake_effort[kHoist] != 0;
  const double hoisting =
      braking ? actuation.brake_effort[kHoist]
              : (p.hoist_gain_mpspv * (v[kHoist] - friction[kHoist]) - state.cable_mps) / p.hoist_lag_s;
  return plant::accelerations(p, state, forces, hoisting, actuation.locks);
}

}  // namespace crane::plant
