/// Least-squares fit of one cause; compare_scipy.py fits the same data, model, bounds and start.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "crane/diagnosis/mapping.hpp"
#include "study/own_noise.hpp"

namespace {

using namespace crane::diagnosis;

Runs measured(const crane::configuration::Rig& rig) {
  const auto mapping = load_mapping(std::string{CRANE_MAPPINGS} + "/uw_pendulum.toml");
  const std::string file = std::string{CRANE_MEASURED} + "/uw_pendulum_id1.csv";
  Runs runs;
  for (Run& run : load_run(canonical(crane::recording::read_csv(file), mapping, file), rig, file).runs)
    runs.push_back(prepare(std::move(run), rig));
  return runs;
}

/// Pivot friction, viscous and Coulomb; starts of windows are projected out.
void fit_of_pivot_friction(benchmark::State& state) {
  const auto rig = crane::configuration::load_rig(std::string{CRANE_RIGS} + "/uw_pendulum.toml");
  const Runs runs = measured(rig), none;
  const Study study(rig, runs, none);
  const auto& all = study.candidates();
  const auto found = std::find_if(all.begin(), all.end(), [](const Candidate& c) {
    return c.cause == "swing_pivot_friction" && c.axis == "radial";
  });
  const double inertia = rig.plant.load_mass_kg * std::pow(rig.start.position[crane::plant::kHoist], 2);
  const Effects start{{&*found, {0.02 * inertia, 0.005 * inertia}}};
  const auto fit_in = [&](const Nuisance& nuisance) {
    const WhitenedData data(study, nuisance);
    return fit(data, start, kNothingToBeat, data.base());
  };
  Fitted fitted = fit_in(learnt_nuisance(study));
  // in the noise of the base model, the friction is a disturbance
  const WhitenedData data(study, learnt_nuisance(study, fitted.effects));
  const Evaluation base = data.base();
  for (auto _ : state) fitted = fit(data, start, kNothingToBeat, base);
  state.counters["b_nmsprad"] = fitted.effects[0].values[0];
  state.counters["c_nm"] = fitted.effects[0].values[1];
}
BENCHMARK(fit_of_pivot_friction)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
