#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "compare.hpp"
#include "crane/diagnosis/diagnosis.hpp"
#include "held_out.hpp"
#include "judgement.hpp"
#include "next_experiment.hpp"

namespace crane::diagnosis {
namespace {

/// An effect that leaves less than this share of the loss of drives or load has been taken for noise, which
/// hides what is small beside it.
constexpr double kHiding = 0.95;
constexpr std::size_t kContenders = 3;

Runs prepared(std::vector<Run> runs, const runtime::Rig& rig) {
  Runs all;
  for (Run& run : runs) all.push_back(prepare(std::move(run), rig));
  return all;
}

double total_s(const Runs& runs) {
  double sum = 0;
  for (const PreparedRun& run : runs) sum += run.run.duration_s();
  return sum;
}

/// Whether anything happens in the data.
void require_excitation(const Runs& runs, const runtime::Rig& rig) {
  std::vector<std::string> problems;
  constexpr double kLeast_s = 8;
  if (total_s(runs) < kLeast_s)
    problems.push_back("training data: " + std::to_string(total_s(runs)) + " s in all: at least " +
                       std::to_string(kLeast_s) + " s");
  double most = 0;
  for (const PreparedRun& run : runs)
    for (const Motion& motion : run.motion)
      for (const double rate : motion.rate) most = std::max(most, std::abs(rate));
  if (most < 0.01)
    problems.push_back("training data: nothing of " + rig.name +
                       " moves faster than 0.01 /s: record a motion");
  if (!problems.empty()) throw DataError(problems);
}

/// The motion that tells the first effect from its strongest rival; what the best model leaves is the noise.
std::optional<NextExperiment> proposal(const runtime::Rig& rig, const Hypotheses& found,
                                       const Candidate& rival, const HeldOut& figures) {
  const auto single = std::find_if(found.singles.begin(), found.singles.end(),
                                   [&](const Fitted& f) { return f.effects[0].candidate == &rival; });
  if (single == found.singles.end()) return std::nullopt;
  std::array<double, kOutputs> noise{};
  for (std::size_t i = 0; i < kOutputs; ++i) {
    const auto known = figures.noise.find(kOutputNames[i]);
    noise[i] = known == figures.noise.end() ? 1e-3 : known->second;
  }
  const Effect& first = found.best.effects[0];
  return propose_experiment(rig, *first.candidate, first.values, rival, single->effects[0].values, noise);
}

/// Singles that explain so much that their effect has been taken for noise, best first.
std::vector<Effects> hiding(const Hypotheses& found) {
  std::vector<const Fitted*> order;
  const Evaluation& base = found.base.train;
  for (const Fitted& single : found.singles)
    if (single.train.drive_loss < kHiding * base.drive_loss ||
        single.train.load_loss < kHiding * base.load_loss)
      order.push_back(&single);
  std::sort(order.begin(), order.end(), [](const Fitted* a, const Fitted* b) { return less(*a, *b); });
  order.resize(std::min(order.size(), kContenders));
  std::vector<Effects> effects;
  effects.reserve(order.size());
  for (const Fitted* single : order) effects.push_back(single->effects);
  return effects;
}

/// Noise and disturbance learnt from the residuals of the hypothesis that makes them likeliest: which of two
/// causes leaves less is hardly seen in units of a noise that holds them both.
Hypotheses learnt_anew(Study& study, const Request& request, const Hypotheses& before,
                       const std::vector<Effects>& contenders) {
  request.progress(0.4, "noise and disturbance of what is left");
  const Effects* likeliest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Effects& effects : contenders) {
    const double misfit = study.learn_disturbance(effects);
    if (misfit < least) least = misfit, likeliest = &effects;
  }
  if (likeliest != &contenders.back()) study.learn_disturbance(*likeliest);
  return singles_again(study, request, before);
}

Hypotheses searched(Study& study, const Request& request) {
  request.progress(0.02, "noise and disturbance");
  study.learn_disturbance();
  Hypotheses found = singles(study, request);
  const std::vector<Effects> contenders = hiding(found);
  if (!found.best.effects.empty() && !contenders.empty())
    found = learnt_anew(study, request, found, contenders);
  return extended(study, request, found);
}

Diagnosis diagnosed(const runtime::Rig& rig, const Runs& train, const Runs& test, const Request& request) {
  Study study(rig, train, test, request.excluded);
  const Hypotheses found = searched(study, request);
  request.progress(0.88, "held-out runs");
  const HeldOut figures = held_out(study, found.best.effects, request.seed);
  request.progress(0.9, "what is left");
  auto [result, rivals] = judge(study, found, figures, request.seed);
  if (!rivals.empty()) {
    request.progress(0.95, "which motion would tell them apart");
    result.next_experiment = proposal(rig, found, *rivals[0], result.held_out);
  }
  result.traces = traces(study, found.best.effects);
  request.progress(1, "done");
  return result;
}

}  // namespace

const char* name_of(Verdict verdict) {
  return std::array{"none", "named", "ambiguous", "parameter", "unknown"}[static_cast<std::size_t>(verdict)];
}

Diagnosis diagnose(const runtime::Rig& rig, std::vector<Run> train, std::vector<Run> test,
                   const Request& request) {
  const auto begin = std::chrono::steady_clock::now();
  const Runs training = prepared(std::move(train), rig), testing = prepared(std::move(test), rig);
  require_excitation(training, rig);
  Diagnosis result = diagnosed(rig, training, testing, request);
  result.runtime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace crane::diagnosis
