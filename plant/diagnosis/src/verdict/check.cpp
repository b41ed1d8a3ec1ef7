#include <algorithm>
#include <cmath>
#include <tuple>

#include "crane/diagnosis/diagnosis.hpp"
#include "experiment/next_experiment.hpp"
#include "study/own_noise.hpp"
#include "study/score.hpp"
#include "verdict/excitation.hpp"

namespace crane::diagnosis {
namespace {

/// Largest number of proposals: the simulation of the menu takes seconds for each.
constexpr std::size_t kProposals = 4;
/// Size of the assumed effects, in multiples of the least size that the data show.
constexpr double kTimesLeast = 2;

const Candidate* candidate_of(const Study& study, const Visibility& visibility) {
  const auto found = std::find_if(
      study.candidates().begin(), study.candidates().end(),
      [&](const Candidate& c) { return c.cause == visibility.cause && c.axis == visibility.axis; });
  return found == study.candidates().end() ? nullptr : &*found;
}

/// Effect of kTimesLeast times the least size, inside its bounds.
Effects effect_of(const Study& study, const Visibility& visibility) {
  const Candidate* candidate = candidate_of(study, visibility);
  if (candidate == nullptr || visibility.least.size() != candidate->parameters.size()) return {};
  std::vector<double> values;
  for (std::size_t i = 0; i < visibility.least.size(); ++i) {
    const FreeParameter& p = candidate->parameters[i];
    const double value =
        i == 0 ? p.null + kTimesLeast * (visibility.least[0].value - p.null) : visibility.least[i].value;
    values.push_back(std::clamp(value, p.low, p.high));
  }
  return {{candidate, values}};
}

/// Questions for an experiment: pairs of candidates with the same effect, in the order of decreasing cosine,
/// each once; then invisible candidates against the base model.
std::vector<std::pair<const Visibility*, const Visibility*>> questions(const std::vector<Visibility>& all) {
  std::vector<std::pair<const Visibility*, const Visibility*>> result;
  for (const Visibility& visibility : all)
    if (!visibility.visible) result.emplace_back(&visibility, nullptr);
  std::vector<std::tuple<double, const Visibility*, const Visibility*>> pairs;
  for (const Visibility& visibility : all)
    for (const auto& alike : visibility.alike) {
      const auto other =
          std::find_if(all.begin(), all.end(), [&](const Visibility& v) { return v.label == alike.label; });
      if (other != all.end() && &visibility < &*other)
        pairs.emplace_back(-std::abs(alike.cosine), &visibility, &*other);
    }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [cosine, a, b] : pairs) result.emplace_back(a, b);
  return result;
}

}  // namespace

Check check(const configuration::Rig& rig, std::vector<Run> train, const Request& request) {
  Runs runs = prepared(std::move(train), rig, request.accuracy), none;
  require_excitation(runs, none, rig);
  hold_resting_drives(runs, none);
  const Study study(rig, runs, none, request.excluded, request.accuracy);
  request.progress(0.1, "noise and disturbance");
  const WhitenedData data(study, learnt_base_model(study).calibrated);
  request.progress(0.3, "what the data show");
  Check result;
  ProbeSlopes slopes;
  result.excitation = score_test(data, {}, data.base(), request.seed, slopes).excitation;
  const Disturbances disturbances = disturbances_of(data);
  std::size_t proposals = 0;
  for (const auto& [a, b] : questions(result.excitation)) {
    if (proposals++ >= kProposals) break;
    request.progress(0.5 + 0.1 * static_cast<double>(proposals), "what to record next");
    const Effects one = effect_of(study, *a), other = b != nullptr ? effect_of(study, *b) : Effects{};
    if (one.empty()) continue;
    if (const auto next = propose_experiment(rig, one, other, disturbances))
      result.next.push_back({a->label, b != nullptr ? b->label : "", *next});
  }
  request.progress(1, "done");
  return result;
}

}  // namespace crane::diagnosis
