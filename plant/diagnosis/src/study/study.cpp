#include "study/study.hpp"

#include <algorithm>

#include "crane/plant/pendulum.hpp"
#include "replay/standstill.hpp"
#include "study/inaccuracies.hpp"

namespace crane::diagnosis {
namespace {

double natural_radps_of(const configuration::Rig& rig) {
  return plant::swing_radps(rig.plant.gravity_mps2, rig.start.position[plant::kHoist]);
}

bool is_null(const Effect& effect) {
  for (std::size_t i = 0; i < effect.values.size(); ++i)
    if (effect.values[i] != effect.candidate->parameters[i].null) return false;
  return true;
}

}  // namespace

Study::Study(const configuration::Rig& rig, const Runs& train, const Runs& test,
             const std::vector<std::string>& excluded, const Accuracy& accuracy)
    : natural_radps_{natural_radps_of(rig)},
      base_(holding({rig.plant, rig.terms})),
      candidates_(candidates_for(rig, train)),
      train_(train, natural_radps_),
      test_(test, natural_radps_),
      whole_runs_(train, Part::load, kWholeRun, 0) {
  std::erase_if(candidates_, [&](const Candidate& candidate) {
    return std::find(excluded.begin(), excluded.end(), candidate.cause) != excluded.end();
  });
  inaccurate_ = inaccuracies_of(candidates_, rig, accuracy);
  for (const Candidate& candidate : inaccurate_) {
    Effect& none = no_inaccuracies_.emplace_back(Effect{&candidate, {}});
    for (const FreeParameter& p : candidate.parameters) none.values.push_back(p.null);
  }
}

Crane Study::crane(const Effects& inaccuracies, const Effects& effects) const {
  Crane crane = base_;
  for (const Effects& some : {calibration_beside(inaccuracies, effects), effects})
    for (const Effect& effect : some) crane.terms.push_back(effect.candidate->setting(effect.values));
  return holding(std::move(crane));
}

double Study::zero_std_dev(Output swing) const { return least_noise_of(train_.runs, swing); }

Effects beside(const Effects& inaccuracies, const Effects& effects) {
  Effects others;
  for (const Effect& inaccuracy : inaccuracies)
    if (std::ranges::none_of(effects, [&](const Effect& effect) {
          return effect.candidate->cause == inaccuracy.candidate->cause &&
                 effect.candidate->axis == inaccuracy.candidate->axis;
        }))
      others.push_back(inaccuracy);
  return others;
}

Effects calibration_beside(const Effects& inaccuracies, const Effects& effects) {
  Effects others = beside(inaccuracies, effects);
  std::erase_if(others, is_null);
  return others;
}

Effects visible_beside(const Effects& inaccuracies, const Effects& effects) {
  Effects others = beside(inaccuracies, effects);
  if (effects.empty()) return others;
  const ShowsIn parts = shown_in(effects);
  std::erase_if(others, [&](const Effect& inaccuracy) {
    return !(inaccuracy.candidate->drive && parts.drive) && !(inaccuracy.candidate->load && parts.load);
  });
  return others;
}

}  // namespace crane::diagnosis
