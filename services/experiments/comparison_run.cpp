#include "experiments/comparison_run.hpp"

#include <mutex>

#include "crane/experiment/variant.hpp"
#include "crane/workers/for_each_on_threads.hpp"
#include "crane/workers/process_pool.hpp"
#include "experiments/experiment_run.hpp"

namespace crane::experiments {

experiment::ComparedRun simulate(const PlannedRun& plan) {
  return simulate(plan,
                  experiment::changed_by(experiment::with_start_of(plan.rig, plan.scenario), plan.variant));
}

experiment::ComparedRun simulate(const PlannedRun& plan, const configuration::Rig& started) {
  experiment::ComparedRun run{.scenario = plan.scenario.name,
                              .variant = plan.variant,
                              .controller = std::string{plan.controller->name},
                              .scenario_description = plan.scenario.description,
                              .stopped_because = "",
                              .metrics = {},
                              .samples = {},
                              .least_settling_time_s = plan.scenario.least_settling_time_s};
  TickLog log{std::nullopt};
  try {
    const auto outcome = run_in_process(started, *plan.controller, plan.scenario, log,
                                        stack::Plant::simulated, nullptr, plan.integrator);
    run.stopped_because = outcome.stopped_because;
    run.samples = experiment::samples_from(log.table(outcome.hold_tick));
  } catch (const RunError& error) {
    if (runtime::stop_requested()) throw;
    run.stopped_because = error.what();
    return run;
  }
  const auto maneuver = experiment::maneuver_of(plan.scenario, started);
  if (run.samples.empty() || run.samples.back().time_s < maneuver.last_action_s) return run;
  run.metrics = experiment::evaluate(run.samples, maneuver);
  if (!run.stopped_because.empty()) run.metrics->settling_time_s.reset();
  return run;
}

std::vector<experiment::ComparedRun> simulate_all(std::span<const PlannedRun> plans,
                                                  const Progress& progress) {
  std::vector<experiment::ComparedRun> results(plans.size());
  std::mutex mutex;
  std::size_t done = 0;
  workers::for_each_on_threads(plans.size(), workers::processors(), [&](std::size_t i) {
    results[i] = simulate(plans[i]);
    const std::scoped_lock lock{mutex};
    progress(++done);
  });
  return results;
}

}  // namespace crane::experiments
