#include "verdict/resolution.hpp"

#include <algorithm>
#include <limits>

#include "rules.hpp"
#include "search/compare.hpp"
#include "verdict/judgement.hpp"

namespace crane::diagnosis {
namespace {

/// Where the runs begin.
plant::State place_of(const Runs& runs) {
  plant::State at;
  if (runs.empty()) return at;
  const PreparedRun& first = runs.front();
  if (const auto& trolley_m = first.motion[kTrolleyPosition].position; !trolley_m.empty())
    at.trolley_m = trolley_m.front();
  if (!first.run.cable_m.empty()) at.cable_m = first.run.cable_m.front();
  return at;
}

bool shown(const Study& study, const Effects& effects, const Effect& effect) {
  const Candidate& candidate = *effect.candidate;
  const Runs& runs = study.drive().runs();
  if (!candidate.decay_speed || runs.empty()) return true;
  const double speed = effect.values[*candidate.decay_speed];
  const plant::Axis axis = candidate.drive_output() == kTrolleyPosition ? plant::kTrolley : plant::kSlew;
  return rows_to_stop(study.with(effects), axis, speed, place_of(runs), runs.front().run.period_s) >=
         rules::kRowsToShow;
}

bool acceptable(const Effects& effects, const Hypotheses& hypotheses, std::size_t candidates) {
  return !effects.empty() && std::ranges::any_of(hypotheses.all, [&](const Fitted& fitted) {
    return same(fitted.effects, effects) && accepted(fitted, hypotheses.base, candidates);
  });
}

}  // namespace

double rows_to_stop(const Crane& crane, plant::Axis axis, double speed, plant::State at, double period_s) {
  (axis == plant::kTrolley ? at.trolley_mps : at.slew_radps) = speed;
  const plant::Model model(crane.parameters, crane.terms);
  const double deceleration = model.friction_response(at, {}, {})[axis][axis] * model.friction_v(at, 0, axis);
  return deceleration > 0 ? speed / (deceleration * period_s) : std::numeric_limits<double>::infinity();
}

void name_what_rows_show(const Study& study, const Hypotheses& hypotheses, const Effects& effects,
                         Diagnosis& diagnosis) {
  Effects rest;
  std::vector<Cause> named, hidden;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (shown(study, effects, effects[i])) {
      rest.push_back(effects[i]);
      named.push_back(diagnosis.causes[i]);
    } else {
      hidden.push_back(diagnosis.causes[i]);
    }
  }
  if (hidden.empty()) return;
  for (const Cause& cause : hidden)
    diagnosis.remainder.from.insert(
        diagnosis.remainder.from.begin(),
        cause.axis + ": friction at speeds that the rows are too far apart to show");
  if (acceptable(rest, hypotheses, study.candidates().size())) {
    diagnosis.causes = std::move(named);
    diagnosis.attempted = std::move(hidden);
  } else {
    diagnosis.verdict = Verdict::unknown;
    diagnosis.ambiguous_with.clear();
  }
  diagnosis.sentence = said(diagnosis);
}

}  // namespace crane::diagnosis
