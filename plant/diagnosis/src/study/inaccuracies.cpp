#include "study/inaccuracies.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "study/candidate_shapes.hpp"
#include "study/known_friction.hpp"

namespace crane::diagnosis {
namespace {

/// True when the load mass is free and both drives have commands: only then do the data show the ratio of the
/// inertias of the drives.
bool show_jib_inertia(const std::vector<Candidate>& candidates) {
  const auto has = [&](std::string_view cause, std::string_view axis) {
    return std::ranges::any_of(candidates,
                               [&](const Candidate& c) { return c.cause == cause && c.axis == axis; });
  };
  return has("payload_mass", "") && has("motor_gain", "trolley") && has("motor_gain", "slew");
}

/// The inertia of the jib is never a cause: the data show only its ratios to the masses of load and trolley.
Candidate jib_inertia() {
  CandidateList list;
  list.add(amount("jib_inertia", "", "factor", 0.5, 2, 0.01), Changes::both, InRigFile::yes);
  return list.take().front();
}

}  // namespace

std::vector<double> largest_inaccuracy(const std::string& cause, const std::string& axis,
                                       const configuration::Rig& rig, const Accuracy& accuracy) {
  if (cause == "motor_gain" || cause == "drive_inertia" || cause == "position_scale" ||
      cause == "swing_scale" || cause == "jib_inertia")
    return {accuracy.values};
  if (cause == "cable_length") return {accuracy.values * rig.start.position[plant::kHoist]};
  if (cause == "payload_mass") return {accuracy.values * rig.plant.load_mass_kg};
  const double time_s = accuracy.times_periods * rig.period_s;
  if (cause == "command_delay" || cause == "swing_delay") return {time_s};
  if (cause == "swing_moving_average") return {2 * time_s};  // a mean delays by half its window
  if (cause == "actuator_lag") return {time_s, time_s};
  const KnownFriction friction = known_friction(rig, axis);
  const double coulomb_v = accuracy.friction * friction.least_coulomb_v,
               viscous = accuracy.friction * friction.least_viscous;
  if (cause == "coulomb_friction") return {coulomb_v};
  if (cause == "viscous_friction") return {viscous};
  if (cause == "direction_asymmetry") return {coulomb_v, viscous};
  return {};
}

std::vector<Candidate> inaccuracies_of(std::vector<Candidate> candidates, const configuration::Rig& rig,
                                       const Accuracy& accuracy) {
  if (show_jib_inertia(candidates)) candidates.push_back(jib_inertia());
  constexpr std::array<std::string_view, 8> kCauses{
      "motor_gain",    "coulomb_friction", "viscous_friction", "direction_asymmetry",
      "command_delay", "cable_length",     "payload_mass",     "jib_inertia"};
  std::vector<Candidate> all;
  for (const Candidate& candidate : candidates) {
    if (std::ranges::find(kCauses, candidate.cause) == kCauses.end()) continue;
    const std::vector<double> limits = largest_inaccuracy(candidate.cause, candidate.axis, rig, accuracy);
    if (std::ranges::none_of(limits, [](double limit) { return limit > 0; })) continue;
    Candidate& bounded = all.emplace_back(candidate);
    for (std::size_t i = 0; i < limits.size(); ++i) {
      FreeParameter& p = bounded.parameters[i];
      p.low = std::max(p.low, p.null - limits[i]);
      p.high = std::min(p.high, p.null + limits[i]);
      p.step = std::min(p.step, 0.5 * limits[i]);
    }
    // A quantity that is 0 in the rig file has the accuracy 0: its parameter is not fitted and stays 0.
    std::erase_if(bounded.parameters, [](const FreeParameter& p) { return !(p.low < p.high); });
    bounded.amount_count = std::min(bounded.amount_count, bounded.parameters.size());
  }
  return all;
}

}  // namespace crane::diagnosis
