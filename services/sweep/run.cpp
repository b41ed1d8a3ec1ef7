#include <sstream>

#include "crane/experiment/variant.hpp"
#include "crane/recording/csv.hpp"
#include "crane/runtime/process.hpp"
#include "experiments/comparison_run.hpp"
#include "sweep/draw.hpp"
#include "sweep/sweep.hpp"

namespace crane::sweep {

using recording::shortest;

Run run_of(const Sweep& sweep, std::size_t number) {
  Run run{.number = number};
  std::size_t left = number;
  const auto next = [&left](std::size_t count) {
    const std::size_t index = left % count;
    left /= count;
    return index;
  };
  run.seed = sweep.first_seed + next(static_cast<std::size_t>(sweep.seeds));
  run.controller = sweep.controllers[next(sweep.controllers.size())];
  run.variant = sweep.variants[next(sweep.variants.size())];
  run.on = &sweep.cases[next(sweep.cases.size())];
  if (run.controller.empty()) run.controller = run.on->rig.controller;
  for (std::size_t i = 0; i < sweep.draws.size(); ++i) {
    const Draw& draw = sweep.draws[i];
    run.drawn.push_back(draw.low + (draw.high - draw.low) * uniform(run.seed, i));
  }
  return run;
}

configuration::Rig rig_at_start(const Sweep& sweep, const Run& run) {
  configuration::Rig rig = experiment::with_start_of(run.on->rig, run.on->scenario);
  for (std::size_t i = 0; i < sweep.draws.size(); ++i)
    *number_of(rig, sweep.draws[i].key).value = run.drawn[i];
  return experiment::changed_by(rig, run.variant);
}

experiment::ComparedRun simulate(const Sweep& sweep, const Run& run) {
  const experiments::PlannedRun plan{run.on->scenario, run.on->rig,
                                     &runtime::chosen_controller(run.controller, run.on->rig), run.variant,
                                     sweep.integrator};
  try {
    return experiments::simulate(plan, rig_at_start(sweep, run));
  } catch (const std::exception& error) {
    return {.scenario = run.on->scenario.name,
            .variant = run.variant,
            .controller = run.controller,
            .scenario_description = run.on->scenario.description,
            .stopped_because = error.what(),
            .metrics = {},
            .samples = {}};
  }
}

std::string identity_of(const Sweep& sweep) {
  std::ostringstream text;
  for (const Case& on : sweep.cases) {
    const auto& s = on.scenario;
    text << s.name << ' ' << shortest(s.duration_s) << ' '
         << configuration::to_toml(experiment::with_start_of(on.rig, s));
    for (const auto& move : s.moves) {
      text << "move " << shortest(move.at_s);
      for (const auto& target : move.target) text << ' ' << (target ? shortest(*target) : "-");
    }
    for (const auto& kick : s.kicks)
      text << "kick " << shortest(kick.at_s) << ' ' << shortest(kick.radial_radps) << ' '
           << shortest(kick.tangential_radps);
    for (const auto& excitation : s.excitations) {
      const auto& r = excitation.reference;
      text << "excitation " << shortest(excitation.at_s) << ' ' << r.axis << ' ' << shortest(r.mean_position)
           << ' ' << shortest(r.duration_s);
      for (const auto& sine : r.sines)
        text << ' ' << shortest(sine.amplitude) << ' ' << shortest(sine.frequency_hz) << ' '
             << shortest(sine.phase_rad);
    }
  }
  for (const auto& name : sweep.variants) text << "variant " << name << '\n';
  for (const auto& name : sweep.controllers) text << "controller " << name << '\n';
  for (const auto& draw : sweep.draws)
    text << "draw " << draw.key << ' ' << shortest(draw.low) << ' ' << shortest(draw.high) << '\n';
  text << "integrator " << simulator::kMethodNames[static_cast<std::size_t>(sweep.integrator)] << '\n';
  text << "seeds " << sweep.first_seed << ' ' << sweep.seeds << '\n';
  return text.str();
}

}  // namespace crane::sweep
