#include "experiments/comparison_run.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "crane/experiment/variant.hpp"
#include "experiments/experiment_run.hpp"

namespace crane::experiments {
namespace {

/// Runs plans until all are done or a thread has failed.
class Crew {
 public:
  Crew(std::span<const PlannedRun> plans, const Progress& progress)
      : plans_{plans}, progress_{progress}, results_(plans.size()) {}

  std::vector<experiment::ComparedRun> work() {
    const std::size_t hands =
        std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()), plans_.size());
    {
      std::vector<std::jthread> threads;
      for (std::size_t i = 0; i < hands; ++i) threads.emplace_back([this] { run_what_is_left(); });
    }
    if (failure_) std::rethrow_exception(failure_);
    return std::move(results_);
  }

 private:
  void run_what_is_left() {
    for (std::size_t i = next_++; i < plans_.size(); i = next_++) {
      try {
        results_[i] = simulate(plans_[i]);
      } catch (...) {
        const std::scoped_lock lock{mutex_};
        failure_ = std::current_exception();
        next_ = plans_.size();
        return;
      }
      const std::scoped_lock lock{mutex_};
      progress_(++done_);
    }
  }

  std::span<const PlannedRun> plans_;
  const Progress& progress_;
  std::vector<experiment::ComparedRun> results_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::size_t done_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

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
  return Crew{plans, progress}.work();
}

}  // namespace crane::experiments
