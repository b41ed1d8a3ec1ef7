#include "tuning/lockstep_crane.hpp"

#include <set>

#include "crane/bridge/bridge.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/simulator/component.hpp"
#include "crane/simulator/simulated_board.hpp"
#include "experiments/experiment_run.hpp"

namespace crane::tuning {
namespace {

struct Board {
  const configuration::Rig* truth;
  simulator::Method integrator;
};
/// Board of the stack that this thread builds; global, because ComponentSpec::make cannot capture it.
thread_local Board built{};

/// Presets the counters of trolley and slew, as the bridge of a real rig does: the first measured position is
/// the start position of the rig file, even when sign or scale of an encoder are wrong.
void preset_counters(simulator::SimulatedRig& simulated, const configuration::Rig& rig) {
  const std::array start{simulated.start.trolley_m, simulated.start.slew_rad};
  for (const std::size_t i : {plant::kTrolley, plant::kSlew}) {
    auto& actual = simulated.encoders[i];
    const auto& nominal = rig.encoders[i];
    if (!rig.measures(i) ||
        (actual.sign == nominal.sign && actual.counts_per_unit == nominal.counts_per_unit))
      continue;
    const double counts = nominal.sign * rig.start.position[i] * nominal.counts_per_unit;
    actual.zero = start[i] - actual.sign * counts / actual.counts_per_unit;
  }
}

std::unique_ptr<runtime::Component> make_plant(const runtime::Context& context) {
  auto simulated = simulator::simulated_rig_of(*built.truth);
  simulated.integrator = built.integrator;
  preset_counters(simulated, context.rig);
  return std::make_unique<bridge::Bridge>(context, std::make_unique<simulator::SimulatedBoard>(simulated));
}

struct Outcome {
  configuration::Rig started;
  experiments::RunOutcome run;
};

/// The true rig at the start of a run, with axes and swing of the rig file of the control loop.
configuration::Rig started_truth(const configuration::Rig& truth, const configuration::Rig& started) {
  configuration::Rig actual = truth;
  const double cable_m = truth.start.position[plant::kHoist] + truth.start.cable_length_offset_m;
  actual.start = started.start;
  actual.start.cable_length_offset_m = cable_m - started.start.position[plant::kHoist];
  return actual;
}

Outcome run_on(const configuration::Rig& truth, const configuration::Rig& rig,
               const control::Controller& controller, const experiment::Scenario& scenario,
               experiments::TickLog& log, simulator::Method integrator) {
  Outcome outcome{experiment::with_start_of(rig, scenario), {}};
  const auto actual = started_truth(truth, outcome.started);
  auto components = stack::stack_with(stack::Plant::simulated);
  components.front().make = make_plant;
  built = {&actual, integrator};
  outcome.run = experiments::run_in_process(components, outcome.started, controller, scenario, log);
  return outcome;
}

}  // namespace

experiment::ComparedRun simulate_on(const configuration::Rig& truth, const configuration::Rig& rig,
                                    const control::Controller& controller,
                                    const experiment::Scenario& scenario, simulator::Method integrator) {
  experiment::ComparedRun run{.scenario = scenario.name,
                              .variant = "",
                              .controller = std::string{controller.name},
                              .scenario_description = scenario.description,
                              .stopped_because = "",
                              .metrics = {},
                              .samples = {}};
  experiments::TickLog log{std::nullopt};
  try {
    const auto outcome = run_on(truth, rig, controller, scenario, log, integrator);
    run.stopped_because = outcome.run.stopped_because;
    run.samples = experiment::samples_from(log.table(outcome.run.hold_tick));
    const auto maneuver = experiment::maneuver_of(scenario, outcome.started);
    if (run.samples.empty() || run.samples.back().time_s < maneuver.last_action_s) return run;
    run.metrics = experiment::evaluate(run.samples, maneuver);
    if (!run.stopped_because.empty()) run.metrics->settling_time_s.reset();
  } catch (const std::exception& error) {
    if (runtime::stop_requested()) throw;
    run.stopped_because = error.what();
  }
  return run;
}

std::vector<std::string> exchanged_channels(const configuration::Rig& truth, const configuration::Rig& rig) {
  std::vector<std::string> problems;
  const auto compare = [&](const std::string& table, const std::string& key, const auto& present,
                           const auto& channel, std::size_t count) {
    std::set<int> in_truth, in_rig;
    std::size_t all = 0;
    for (std::size_t i = 0; i < count; ++i)
      if (present(i)) ++all, in_truth.insert(channel(truth, i)), in_rig.insert(channel(rig, i));
    if (in_truth.size() < all || in_rig.size() < all) return;  // a rig file that states no channels
    for (std::size_t i = 0; i < count; ++i)
      if (present(i) && channel(truth, i) != channel(rig, i))
        problems.push_back(truth.path + ": " + table + "." + plant::kCoordinates[i].name + "." + key + " = " +
                           std::to_string(channel(truth, i)) + ": must be " +
                           std::to_string(channel(rig, i)) +
                           " as in --rig: a simulation in lockstep has no board with channels");
  };
  using configuration::Rig;
  compare(
      "drive", "dac_channel", [&](std::size_t i) { return rig.drives[i].present && truth.drives[i].present; },
      [](const Rig& one, std::size_t i) { return one.drives[i].dac_channel; }, rig.drives.size());
  compare(
      "encoder", "channel", [&](std::size_t i) { return rig.measures(i) && truth.measures(i); },
      [](const Rig& one, std::size_t i) { return one.encoders[i].channel; }, rig.encoders.size());
  return problems;
}

Motion LockstepCrane::execute(const configuration::Rig& rig, const experiment::Scenario& scenario) {
  experiments::TickLog log{std::nullopt};
  try {
    const auto outcome =
        run_on(truth_, rig, *control::find_controller("none"), scenario, log, simulator::Method::cvode);
    return {log.table(outcome.run.hold_tick), outcome.run.stopped_because};
  } catch (const experiments::RunError& error) {
    if (runtime::stop_requested()) throw;
    return {log.table(0), error.what()};  // the rows show why, for example a motion against the voltage
  }
}

}  // namespace crane::tuning
