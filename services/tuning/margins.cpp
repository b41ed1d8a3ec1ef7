#include "tuning/margins.hpp"

#include <algorithm>
#include <functional>

#include "crane/experiment/metrics.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::tuning {
namespace {

constexpr double kStableSwing_rad = 2 * experiment::kSettlingSwing_rad;  // residual swing of a stable loop
constexpr std::size_t kFrictionChanges = 2;  // number of changes of friction, last

double& parameter(configuration::Rig& rig, const std::string& term, const std::string& axis,
                  const std::string& name, double missing) {
  for (auto& setting : rig.terms)
    if (setting.name == term && setting.axis == axis)
      return setting.parameters.try_emplace(name, missing).first->second;
  rig.terms.push_back({term, axis, {{name, missing}}});
  return rig.terms.back().parameters.at(name);
}

void for_drives(configuration::Rig& rig, const std::function<void(const std::string&)>& change) {
  for (const std::size_t axis : {plant::kTrolley, plant::kSlew})
    if (rig.drives[axis].present) change(plant::kCoordinates[axis].name);
}

configuration::Rig with_delay(configuration::Rig rig, double periods) {
  for_drives(rig, [&](const std::string& axis) {
    parameter(rig, "command_delay", axis, "delay_s", 0) += periods * rig.period_s;
  });
  return rig;
}

/// Multiplies the gains of the drives. The friction in volts, and therefore its compensation, is unchanged.
configuration::Rig with_gain(configuration::Rig rig, double factor) {
  rig.plant.trolley_gain_mps2pv *= factor;
  rig.plant.slew_gain_radps2pv *= factor;
  return rig;
}

/// Changes 0 ... 5: shorter, longer cable; lighter, heavier load; less, more friction.
configuration::Rig with_change(configuration::Rig rig, std::size_t change) {
  const double sign = change % 2 == 0 ? -1 : 1;
  if (change / 2 == 0)
    rig.start.cable_length_offset_m +=
        sign * kCableChange * (rig.start.position[plant::kHoist] + rig.start.cable_length_offset_m);
  if (change / 2 == 1) rig.plant.load_mass_kg *= 1 + sign * kLoadChange;
  if (change / 2 == 2)
    for (auto& term : rig.terms)
      if (term.name == "drive_friction")
        for (auto& [name, value] : term.parameters)
          if (name.starts_with("coulomb") || name.starts_with("viscous")) value *= 1 + sign * kFrictionChange;
  return rig;
}

bool is_stable(const experiment::ComparedRun& run) {
  return run.stopped_because.empty() && run.metrics && run.metrics->residual_swing_rad < kStableSwing_rad;
}

}  // namespace

std::optional<double> mean_of(const std::vector<std::optional<double>>& times) {
  double sum = 0;
  for (const auto& time : times) {
    if (!time) return std::nullopt;
    sum += *time;
  }
  return sum / static_cast<double>(times.size());
}

MarginRuns::MarginRuns(std::size_t maneuvers)
    : maneuvers_{maneuvers},
      stable_(kCases * maneuvers),
      complete_(kCases * maneuvers),
      settling_(kCases * maneuvers) {}

configuration::Rig MarginRuns::truth_of(const configuration::Rig& truth, std::size_t number) {
  if (number < kTestedDelays_periods.size()) return with_delay(truth, kTestedDelays_periods[number]);
  number -= kTestedDelays_periods.size();
  if (number < kTestedGains.size()) return with_gain(truth, kTestedGains[number]);
  return with_change(truth, number - kTestedGains.size());
}

void MarginRuns::take(std::size_t run, const experiment::ComparedRun& result) {
  stable_[run] = is_stable(result);
  complete_[run] = result.stopped_because.empty();
  settling_[run] = result.metrics ? result.metrics->settling_time_s : std::nullopt;
}

Margins MarginRuns::margins() const {
  Margins found;
  for (std::size_t i = 0; i < kTestedDelays_periods.size() && all(stable_, i); ++i)
    found.delay_periods = kTestedDelays_periods[i];
  for (std::size_t i = 0; i < kTestedGains.size() && all(stable_, kTestedDelays_periods.size() + i); ++i)
    found.gain = kTestedGains[i];
  found.survives_changes = true;
  found.changed_settling_s = 0;
  for (std::size_t i = kCases - kChanges; i < kCases; ++i) {
    const bool friction = i >= kCases - kFrictionChanges;
    found.survives_changes = found.survives_changes && (friction ? all(complete_, i) : all(stable_, i));
    const auto mean = mean_of({settling_.begin() + static_cast<std::ptrdiff_t>(i * maneuvers_),
                               settling_.begin() + static_cast<std::ptrdiff_t>((i + 1) * maneuvers_)});
    if (!mean) found.changed_settling_s.reset();
    if (found.changed_settling_s) *found.changed_settling_s = std::max(*found.changed_settling_s, *mean);
  }
  return found;
}

bool MarginRuns::all(const std::vector<bool>& results, std::size_t number) const {
  const auto begin = results.begin() + static_cast<std::ptrdiff_t>(number * maneuvers_);
  return std::all_of(begin, begin + static_cast<std::ptrdiff_t>(maneuvers_),
                     [](bool result) { return result; });
}

}  // namespace crane::tuning
