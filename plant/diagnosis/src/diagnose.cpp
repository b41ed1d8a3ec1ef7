#include <algorithm>
#include <chrono>
#include <cmath>

#include "crane/diagnosis/diagnosis.hpp"
#include "held_out.hpp"
#include "judgement.hpp"
#include "next_experiment.hpp"

namespace crane::diagnosis {
namespace {

/// An effect that leaves less than this share of the residual hides the noise, and what is small beside it.
/// Around standstill the noise of a drive is rougher: what is left of it tells less, and has to be left to be
/// doubted.
constexpr double kLittleLeftOfDrives = 0.25, kLittleLeftOfLoad = 0.6;

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

/// Whether the likeliest hypothesis explains so much that noise and disturbance are to be learnt from what it
/// leaves.
bool hides_the_noise(const Hypotheses& found) {
  const Evaluation &base = found.base.train, &left = found.likeliest.train;
  return excess(found.likeliest) <= 1 && (left.drive_loss < kLittleLeftOfDrives * base.drive_loss ||
                                          left.load_loss < kLittleLeftOfLoad * base.load_loss);
}

/// With noise and disturbance learnt from what `before` leaves; then the singles are fitted anew.
Hypotheses learnt_anew(Study& study, const Request& request, const Hypotheses& before) {
  request.progress(0.4, "noise and disturbance of what is left");
  study.learn_disturbance(before.likeliest.effects);
  return singles_again(study, request, before);
}

Hypotheses searched(Study& study, const Request& request) {
  request.progress(0.02, "noise and disturbance");
  study.learn_disturbance();
  Hypotheses found = singles(study, request);
  if (hides_the_noise(found)) return extended(study, request, learnt_anew(study, request, found));
  found = extended(study, request, found);
  return hides_the_noise(found) ? extended(study, request, learnt_anew(study, request, found)) : found;
}

Diagnosis diagnosed(const runtime::Rig& rig, const Runs& train, const Runs& test, const Request& request) {
  Study study(rig, train, test, request.excluded);
  const Hypotheses found = searched(study, request);
  request.progress(0.88, "held-out runs");
  const HeldOut figures = held_out(study, test, found.best.effects, request.seed);
  request.progress(0.9, "what is left");
  auto [result, rivals] = judge(study, found, figures, request.seed);
  if (!rivals.empty()) {
    request.progress(0.95, "which motion would tell them apart");
    result.next_experiment = proposal(rig, found, *rivals[0], result.held_out);
  }
  result.traces = traces(test, study.base(), study.with(found.best.effects));
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
