#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "crane/diagnosis/diagnosis.hpp"
#include "crane/diagnosis/moment.hpp"
#include "experiment/next_experiment.hpp"
#include "search/compare.hpp"
#include "search/held_out.hpp"
#include "search/intervals.hpp"
#include "verdict/excitation.hpp"
#include "verdict/judgement.hpp"
#include "verdict/losing_encoders.hpp"

namespace crane::diagnosis {
namespace {

/// An effect that leaves less than this share of the loss of drives or load has been taken for noise, which
/// hides what is small beside it.
constexpr double kHiding = 0.95;
/// So has one that leaves less of the error of a swing, in rad: a force of any size makes up for what goes
/// with none.
constexpr double kFollowed = 0.8;
/// Of the drives, and of the load.
constexpr std::size_t kContenders = 2;
/// A smaller share of the held-out error, where a cause acts, has to be beyond doubt. Several causes that are
/// not worth so much each are rather what two laws make of one that has no name.
constexpr double kWorthwhile = 0.05;
/// A simulated motion of less than this share of the measured one is none.
constexpr double kStandsStill = 0.1;
/// Errors of a swing over whole runs in open loop may grow by that much: phase drifts. Of drives nothing is
/// asked there, where the smallest error of friction integrates into position.
constexpr double kWorseOverWholeRuns = 1.25;
/// Of the squares of a motion over whole runs that the base model follows, the extended model has to follow
/// at least this share: friction that is off by a little lets an axis drift, one that holds it fast explains
/// nothing.
constexpr double kStillFollowed = 0.5;

/// Whether a swing is simulated so much better that what was wrong with it has been taken for a force.
bool follows_better(const Study& study, const Fitted& fitted) {
  const auto left = [&](const Fits& fits, std::size_t output) {
    return std::sqrt(sum(study.load().squares_left(fits, output)));
  };
  for (std::size_t output = 0; output < study.load().outputs().size(); ++output)
    if (left(fitted.train.load, output) < kFollowed * left(study.base_train().load, output)) return true;
  return false;
}

/// Singles that explain so much that their effect has been taken for noise, the best ones of the drives and
/// of the load.
std::vector<Effects> hiding(const Study& study, const Hypotheses& found) {
  std::vector<const Fitted*> order;
  const Evaluation& base = found.base.train;
  for (const Fitted& single : found.singles)
    if (single.train.drive_loss < kHiding * base.drive_loss ||
        single.train.load_loss < kHiding * base.load_loss || follows_better(study, single))
      order.push_back(&single);
  std::vector<Effects> effects;
  for (const auto loss : {&Evaluation::drive_loss, &Evaluation::load_loss}) {
    std::sort(order.begin(), order.end(),
              [&](const Fitted* a, const Fitted* b) { return a->train.*loss < b->train.*loss; });
    for (std::size_t i = 0; i < std::min(order.size(), kContenders); ++i)
      if (std::none_of(effects.begin(), effects.end(),
                       [&](const Effects& known) { return same(known, order[i]->effects); }))
        effects.push_back(order[i]->effects);
  }
  return effects;
}

/// Noise and disturbance learnt from the residuals of the hypotheses that make them likeliest: which of two
/// causes leaves less is hardly seen in units of a noise that holds them both.
Hypotheses learnt_anew(Study& study, const Request& request, const Hypotheses& before,
                       const std::vector<Effects>& contenders) {
  request.progress(0.4, "noise and disturbance of what is left");
  Noise likeliest = study.noise();
  for (const Effects& effects : contenders) {
    study.learn_disturbance(effects);
    likeliest.take_likelier(study.noise());
  }
  study.whiten_with(likeliest);
  return singles_again(study, request, before);
}

Hypotheses searched(Study& study, const Request& request) {
  request.progress(0.02, "noise and disturbance");
  study.learn_disturbance();
  Hypotheses found = singles(study, request);
  const std::vector<Effects> contenders = hiding(study, found);
  if (!contenders.empty()) found = learnt_anew(study, request, found, contenders);
  return extended(study, request, found);
}

/// The best hypothesis with values of its own: in noise and disturbance of what itself leaves.
Fitted settled(Study& study, const Fitted& best, std::uint64_t seed) {
  study.learn_disturbance(best.effects);
  return with_intervals(study, study.fit(best.effects), seed);
}

void give_values(const Fitted& best, Diagnosis& result) {
  const std::vector<Estimate> values = estimates(best);
  auto next = values.begin();
  for (std::size_t i = 0; i < best.effects.size(); ++i) {
    const Effect& effect = best.effects[i];
    const auto end = next + static_cast<std::ptrdiff_t>(effect.values.size());
    result.causes[i].parameters.assign(next, end);
    next = end;
    result.extension.push_back(effect.candidate->setting(effect.values));
  }
  for (Ranked& ranked : result.ranking)
    if (ranked.label == label_of(best.effects)) ranked.parameters = values;
}

/// Of the column that a cause improves most, of those that it acts on.
double gain_where_it_acts(const HeldOut& held_out, const Candidate& cause) {
  double most = 0;
  for (const Output output : kAllOutputs) {
    const auto before = held_out.baseline_rms.find(kOutputNames[output]);
    if (before == held_out.baseline_rms.end() || !cause.acts_on(output) || !(before->second > 0)) continue;
    most = std::max(most, 1 - held_out.extended_rms.at(before->first) / before->second);
  }
  return most;
}

bool acts_on(const Effects& effects, const std::string& column) {
  return std::ranges::any_of(effects, [&](const Effect& effect) {
    return std::ranges::any_of(kAllOutputs, [&](Output output) {
      return column == kOutputNames[output] && effect.candidate->acts_on(output);
    });
  });
}

/// Whether the extended model loses over whole runs what the base model followed of a motion.
bool loses_motion(const HeldOut& held_out, const std::string& column) {
  const auto squares = [&column](const std::map<std::string, double>& rms) {
    const auto found = rms.find(column);
    return found == rms.end() ? 0.0 : found->second * found->second;
  };
  const double moved = squares(held_out.whole_held_value_rms);
  const double followed_before = moved - squares(held_out.whole_baseline_rms);
  const double followed = moved - squares(held_out.whole_extended_rms);
  return followed_before > 0 && followed < kStillFollowed * followed_before;
}

/// Why held-out runs do not speak for the extended model; empty when they do.
std::string held_out_doubt(const HeldOut& held_out, const Effects& effects) {
  const bool nothing_held_out = held_out.baseline_rms.empty();
  if (effects.empty() || nothing_held_out) return "";
  const bool gains = effects.size() > 1 ? held_out.gain >= kWorthwhile * static_cast<double>(effects.size())
                                        : gain_where_it_acts(held_out, *effects[0].candidate) >= kWorthwhile;
  if (!gains && !(held_out.gain_ci95[0] > 0))
    return "held-out runs: the extended model hardly simulates them better";
  if (!(held_out.gain_ci95[0] > 0))
    return "held-out runs: the extended model may simulate them worse (the interval of the gain reaches "
           "below 0)";
  for (const auto& [column, motion] : held_out.whole_extended_motion)
    if (acts_on(effects, column) && motion < kStandsStill)
      return "held-out runs: " + column + " moves, and stands still in the extended model";
  for (const auto& [column, before] : held_out.whole_baseline_rms)
    if (column.starts_with("swing") && acts_on(effects, column) &&
        held_out.whole_extended_rms.at(column) > kWorseOverWholeRuns * before)
      return "held-out runs: over whole runs the extended model simulates " + column + " worse";
  for (const auto& [column, before] : held_out.whole_baseline_rms)
    if (acts_on(effects, column) && loses_motion(held_out, column))
      return "held-out runs: over whole runs the extended model follows " + column +
             " less than half as well as the base model";
  return "";
}

/// Runs to learn from and held out.
struct Data {
  Runs train, test;
};

/// @param study of data in which what `losing` encoders lost is put back
/// @param as_measured of the data before that; `study` itself where nothing was lost
Diagnosis diagnosed(const configuration::Rig& rig, Study& study, Study& as_measured,
                    const std::vector<LosingEncoder>& losing, const Request& request) {
  Hypotheses found = searched(study, request);
  request.progress(0.85, "what is left");
  auto [result, rival] = judge(study, found, losing, request.seed);
  result.excitation = found.excitation;
  if (!found.best.effects.empty()) {
    request.progress(0.88, "how well the data know it");
    found.best = settled(study, found.best, request.seed);
    give_values(found.best, result);
  }
  request.progress(0.92, "held-out runs");
  if (!losing.empty()) as_measured.whiten_with(study.noise());
  result.held_out = held_out(study, as_measured, found.best.effects, request.seed);
  if (const std::string why = held_out_doubt(result.held_out, found.best.effects); !why.empty())
    doubt(result, why);
  if (result.verdict == Verdict::ambiguous) {
    request.progress(0.95, "which motion would tell them apart");
    result.next_experiment = propose_experiment(rig, found.best.effects, rival, disturbances_of(study));
  }
  name_losing(losing, study, as_measured, result);
  if (result.verdict == Verdict::unknown) {  // encoders that lose counts are known by their jumps alone
    const auto first =
        result.causes.begin() + static_cast<std::ptrdiff_t>(std::min(losing.size(), result.causes.size()));
    result.attempted.assign(first, result.causes.end());
    result.causes.erase(first, result.causes.end());
  }
  result.traces = traces(study, as_measured, found.best.effects);
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
  const Data measured{prepared(train, rig), prepared(test, rig)};
  require_excitation(measured.train, measured.test, rig);
  Study as_measured(rig, measured.train, measured.test, request.excluded);
  std::vector<LosingEncoder> losing;
  if (considered(request, "position_drift")) losing = losing_encoders(train, rig);
  Diagnosis result;
  if (losing.empty()) {
    result = diagnosed(rig, as_measured, as_measured, losing, request);
  } else {
    const Data mended{prepared(put_back(std::move(train), losing), rig),
                      prepared(put_back(std::move(test), losing), rig)};
    Study study(rig, mended.train, mended.test, request.excluded);
    result = diagnosed(rig, study, as_measured, losing, request);
  }
  result.runtime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace crane::diagnosis
