#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "crane/diagnosis/diagnosis.hpp"
#include "crane/diagnosis/kinematics.hpp"
#include "experiment/next_experiment.hpp"
#include "rules.hpp"
#include "search/block_votes.hpp"
#include "search/compare.hpp"
#include "search/held_out.hpp"
#include "search/intervals.hpp"
#include "verdict/excitation.hpp"
#include "verdict/judgement.hpp"
#include "verdict/losing_encoders.hpp"
#include "verdict/proof.hpp"
#include "verdict/sentence.hpp"

namespace crane::diagnosis {
namespace {

/// @param within_accuracy by effect
void give_values(const Fitted& best, const std::vector<bool>& within_accuracy, Diagnosis& result) {
  const std::vector<Estimate> values = estimates(best.effects, best.interval_std_dev);
  auto next = values.begin();
  auto cause = result.causes.begin(), small = result.within_accuracy.begin();
  for (std::size_t i = 0; i < best.effects.size(); ++i) {
    const Effect& effect = best.effects[i];
    const auto end = next + static_cast<std::ptrdiff_t>(effect.values.size());
    (within_accuracy[i] ? small++ : cause++)->parameters.assign(next, end);
    next = end;
    result.extension.push_back(effect.candidate->setting(effect.values));
  }
  for (Ranked& ranked : result.ranking)
    if (ranked.label == label_of(best.effects)) ranked.parameters = values;
}

/// Adds the quantities of the rig file with the values that they have in the extended model.
void give_calibration(const Effects& calibration, Diagnosis& result) {
  for (const Effect& effect : calibration) {
    Calibrated& given = result.calibrated.emplace_back(effect.candidate->cause, effect.candidate->axis);
    for (std::size_t i = 0; i < effect.values.size(); ++i) {
      const FreeParameter& p = effect.candidate->parameters[i];
      given.parameters.push_back({p.name, std::string{plant::unit_on(given.axis, p.unit)}, effect.values[i],
                                  p.null, std::max(p.high - p.null, p.null - p.low)});
    }
    result.extension.push_back(effect.candidate->setting(effect.values));
  }
  result.sentence = sentence_of(result);
}

/// Changes the verdict to "none".
void nothing_found(Diagnosis& result) {
  result.verdict = Verdict::none;
  result.causes.clear();
  result.extension.clear();
  result.ambiguous_with.clear();
  result.sentence = sentence_of(result);
}

/// Training runs and held-out runs.
struct Data {
  Runs train, test;
};

/// True if the data give no evidence of an error although the held-out runs do not prove the extension. The
/// residual of the base model decides if the extension has no consequence, if its values are insignificant,
/// or if training and held-out data together are not significant and the held-out likelihood decreases no
/// more than superfluous values cause. Otherwise the error has another cause.
/// @param best the unproven fit, with its intervals
bool nothing_wrong(const Study& study, const Hypotheses& found, const StatedAccuracy& accuracy,
                   const Fitted& best, const Proof& proof, const HeldOut& held_out, std::uint64_t seed) {
  const std::size_t candidates = study.candidates().size();
  const bool matters = share_of_error(found.best, found.base) >= rules::kWorthwhile;
  const bool insignificant_effect =
      insignificant(wald_p_value(best), candidates) ||
      (insignificant(likelihood_ratio_p_value(found.best, found.base, held_out.nats), candidates) &&
       insignificant(held_out_loss_p_value(found.best, found.base, held_out.nats), candidates));
  if (matters && !insignificant_effect && proof.outcome != Proof::Outcome::no_consequence) return false;
  const WhitenedData data(study, found.base.nuisance);
  Hypotheses base = found;
  base.base.train = data.base();
  base.best = base.base;
  return judge(data, base, base.best, accuracy, {}, seed).diagnosis.verdict == Verdict::none;
}

/// @param study of the data with restored counts of the `losing` encoders
/// @param as_measured of the data as measured; `study` itself if no counts were lost
Diagnosis diagnosed(const configuration::Rig& rig, const Study& study, const Study& as_measured,
                    const std::vector<LosingEncoder>& losing, const Request& request) {
  request.progress(0.02, "noise and disturbance");
  const BaseModel base_model = learnt_base_model(study);
  Hypotheses found = searched(study, base_model, request);
  const WhitenedData data(study, found.best.nuisance);
  Fitted best = found.best;
  if (!best.effects.empty()) {
    request.progress(0.85, "standard deviations");
    best = with_intervals(data, best, request.seed);
  }
  request.progress(0.88, "patterns in the residual");
  const StatedAccuracy accuracy(rig, request.accuracy);
  auto [result, rival, within_accuracy] = judge(data, found, best, accuracy, losing, request.seed);
  result.excitation = found.excitation;
  give_values(best, within_accuracy, result);
  if (result.verdict == Verdict::none) {
    best = found.base;
    result.extension.clear();
  }
  request.progress(0.92, "held-out runs");
  result.held_out = held_out(study, as_measured, best, request.seed);
  if (!result.held_out.baseline_rms.empty() && !best.effects.empty()) {
    const Blocks before = held_out_deviance(study, found.base), now = held_out_deviance(study, best);
    result.held_out.nats = 0.5 * (sum(before) - sum(now));
    result.held_out.likelier = block_wins(now, before, request.seed);
  }
  const Proof proof = proof_of(result.held_out, best.effects);
  if (proof.outcome != Proof::Outcome::proven) {
    if (losing.empty() && result.verdict != Verdict::unknown &&
        nothing_wrong(study, found, accuracy, best, proof, result.held_out, request.seed)) {
      best = found.base;
      nothing_found(result);
      result.held_out = held_out(study, as_measured, best, request.seed);
    } else {
      make_unknown(result, proof.why);
    }
  }
  if (result.verdict == Verdict::ambiguous) {
    request.progress(0.95, "experiment that separates the hypotheses");
    result.next_experiment =
        propose_experiment(rig, best.effects, rival, disturbances_of(WhitenedData(study, best.nuisance)));
  }
  give_calibration(calibration_beside(best.nuisance.inaccuracies, best.effects), result);
  if (!losing.empty()) {
    const WhitenedData restored(study, best.nuisance), measured(as_measured, best.nuisance);
    name_losing(losing, measured.base().loss - restored.base().loss, result);
  }
  if (result.verdict == Verdict::unknown) {  // the jumps alone prove that an encoder loses counts
    const auto first =
        result.causes.begin() + static_cast<std::ptrdiff_t>(std::min(losing.size(), result.causes.size()));
    result.attempted.assign(first, result.causes.end());
    result.causes.erase(first, result.causes.end());
  }
  result.traces = traces(study, as_measured, best);
  request.progress(1, "done");
  return result;
}

bool considered(const Request& request, const std::string& cause) {
  return std::find(request.excluded.begin(), request.excluded.end(), cause) == request.excluded.end();
}

}  // namespace

const char* name_of(Verdict verdict) {
  return std::array{"none", "named", "ambiguous", "parameter", "unknown"}[static_cast<std::size_t>(verdict)];
}

Diagnosis diagnose(const configuration::Rig& rig, std::vector<Run> train, std::vector<Run> test,
                   const Request& request) {
  const auto begin = std::chrono::steady_clock::now();
  Data measured{prepared(train, rig, request.accuracy), prepared(test, rig, request.accuracy)};
  require_excitation(measured.train, measured.test, rig);
  hold_resting_drives(measured.train, measured.test);
  const Study as_measured(rig, measured.train, measured.test, request.excluded, request.accuracy);
  std::vector<LosingEncoder> losing;
  if (considered(request, "position_drift")) losing = losing_encoders(train, rig);
  Diagnosis result;
  if (losing.empty()) {
    result = diagnosed(rig, as_measured, as_measured, losing, request);
  } else {
    Data mended{prepared(without_count_losses(std::move(train), losing, rig), rig, request.accuracy),
                prepared(without_count_losses(std::move(test), losing, rig), rig, request.accuracy)};
    hold_resting_drives(mended.train, mended.test);
    const Study study(rig, mended.train, mended.test, request.excluded, request.accuracy);
    result = diagnosed(rig, study, as_measured, losing, request);
  }
  result.accuracy = request.accuracy;
  result.runtime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace crane::diagnosis
