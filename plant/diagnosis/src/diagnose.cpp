#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "crane/diagnosis/diagnosis.hpp"
#include "held_out.hpp"
#include "next_experiment.hpp"
#include "study.hpp"
#include "unexplained.hpp"

namespace crane::diagnosis {
namespace {

/// A score this unlikely by luck is something.
constexpr double kSignificant = 0.01;
/// Held-out data are fewer: they have to agree, not to prove it alone.
constexpr double kHeldOutWin = 0.9;
/// Mean square of the whitened residual beyond which noise and a coloured force cannot have made it. Swing
/// keeps to 1 within a few percent; a drive that breaks loose a moment too late or early leaves more.
constexpr double kWorstSwing = 1.25, kWorstDrive = 4;
/// What improves the training loss by a smaller share is of no consequence for the crane.
constexpr double kLeastShare = 0.01;
/// A second effect has to be worth more than a better-fitting shape of the first.
constexpr double kLeastPairShare = 0.01;
constexpr std::size_t kRefitted = 8;
constexpr std::size_t kPaired = 5;
constexpr int kVotes = 500;
constexpr double kClearWin = 0.8;
constexpr double kRunnerUp = 0.1;
/// Share of the drives' loss beyond which an unexplained pattern is taken seriously: friction around
/// standstill leaves patterns of a few percent in clean data.
constexpr double kPatternShare = 0.12;
/// An unexplained pattern this large against what the named effects explain makes the name doubtful.
constexpr double kDoubtful = 0.35;

bool same(const Effects& a, const Effects& b) {
  if (a.size() != b.size()) return false;
  return std::all_of(a.begin(), a.end(), [&](const Effect& e) {
    return std::any_of(b.begin(), b.end(), [&](const Effect& f) { return f.candidate == e.candidate; });
  });
}

bool holds(const Effects& effects, const Candidate* candidate) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const Effect& e) { return e.candidate == candidate; });
}

double mean_square(const Fits& fits) {
  double sum = 0, count = 0;
  for (const WindowFit& fit : fits)
    sum += fit.residual.squaredNorm(), count += static_cast<double>(fit.residual.size());
  return count > 0 ? sum / count : 0;
}

class Search {
 public:
  Search(const runtime::Rig& rig, const Runs& train, const Runs& test, const Request& request)
      : rig_(rig), test_(test), request_(request), study_(rig, train, test) {}

  Diagnosis run() {
    request_.progress(0.02, "noise and disturbance");
    study_.learn_disturbance();
    base_.train = study_.base_train();
    base_.test = study_.base_test();
    request_.progress(0.1, "scores of all candidates");
    const ScoreTable scores = study_.score({}, base_.train, request_.seed);
    result_.detection_p_value = scores.p_value;
    singles(scores);
    Fitted best = *std::min_element(singles_.begin(), singles_.end(),
                                    [&](const Fitted& a, const Fitted& b) { return value(a) < value(b); });
    if (!accepted(best, base_, kLeastShare)) {
      best = base_;
    } else {
      best = extend(best);
    }
    conclude(best);
    return std::move(result_);
  }

 private:
  /// What a hypothesis is judged by: training and held-out loss together with a price for its parameters.
  [[nodiscard]] double value(const Fitted& f) const {
    return f.train.loss + f.test.loss + price() * static_cast<double>(f.parameters);
  }
  [[nodiscard]] double price() const {
    return std::log(static_cast<double>(base_.train.blocks.size() + base_.test.blocks.size()));
  }

  /// Better in training by a share that matters, and out of sample beyond doubt.
  [[nodiscard]] bool accepted(const Fitted& f, const Fitted& before, double share) const {
    if (before.train.loss - f.train.loss < share * base_.train.loss) return false;
    const Wins wins = block_wins(f, before);
    return wins.all > 1 - kSignificant && wins.held_out > kHeldOutWin;
  }

  /// Shares of resamples of all blocks in which `f` is better than `before`: in all, in the held-out ones.
  struct Wins {
    double all = 0, held_out = 0;
  };
  [[nodiscard]] Wins block_wins(const Fitted& f, const Fitted& before) const {
    std::vector<double> difference;
    for (std::size_t i = 0; i < f.train.blocks.size(); ++i)
      difference.push_back(before.train.blocks[i] - f.train.blocks[i]);
    const std::size_t training = difference.size();
    for (std::size_t i = 0; i < f.test.blocks.size(); ++i)
      difference.push_back(before.test.blocks[i] - f.test.blocks[i]);
    const double extra =
        price() * (static_cast<double>(f.parameters) - static_cast<double>(before.parameters));
    std::mt19937_64 random(request_.seed);
    Wins wins;
    for (int i = 0; i < kVotes; ++i) {
      double all = -extra, held_out = 0;
      for (std::size_t k = 0; k < difference.size(); ++k) {
        const std::size_t at = static_cast<std::size_t>(random() % difference.size());
        all += difference[at];
        if (at >= training) held_out += difference[at];
      }
      wins.all += all > 0 ? 1.0 / kVotes : 0;
      wins.held_out += f.test.blocks.empty() || held_out > 0 ? 1.0 / kVotes : 0;
    }
    return wins;
  }

  Effect begin(const Score& score) const {
    const Candidate& candidate = study_.candidates()[score.candidate];
    return {&candidate, candidate.begin(candidate.shapes[score.shape], score.amounts)};
  }

  void singles(const ScoreTable& scores) {
    std::vector<Score> order = scores.best;
    std::sort(order.begin(), order.end(), [](const Score& a, const Score& b) { return a.gain > b.gain; });
    for (std::size_t i = 0; i < std::min(kRefitted, order.size()); ++i) {
      request_.progress(0.15 + 0.3 * static_cast<double>(i) / kRefitted,
                        "fit of " + study_.candidates()[order[i].candidate].label());
      singles_.push_back(study_.fit({begin(order[i])}));
      rank(singles_.back(), order[i].p_value);
    }
    all_ = singles_;
  }

  void rank(const Fitted& f, double p_value) {
    Ranked ranked;
    for (const Effect& effect : f.effects)
      ranked.label += (ranked.label.empty() ? "" : " + ") + effect.candidate->label();
    ranked.parameters = estimates(f);
    ranked.train_gain = base_.train.loss - f.train.loss;
    ranked.test_gain = base_.test.loss - f.test.loss;
    ranked.p_value = p_value;
    result_.ranking.push_back(ranked);
  }

  static std::vector<Estimate> estimates(const Fitted& f) {
    std::vector<Estimate> all;
    std::size_t i = 0;
    for (const Effect& effect : f.effects)
      for (std::size_t k = 0; k < effect.values.size(); ++k, ++i)
        all.push_back({effect.candidate->parameters[k].name, effect.candidate->parameters[k].unit,
                       effect.values[k], f.std_dev[i]});
    return all;
  }

  /// Forward from the best, pairs of the best singles beside it.
  Fitted extend(Fitted best) {
    for (std::size_t effects = 2; effects <= request_.most_effects; ++effects) {
      request_.progress(0.45 + 0.2 * static_cast<double>(effects - 2), "is there another effect?");
      const ScoreTable scores = study_.score(best.effects, best.train, request_.seed + effects);
      if (scores.p_value > kSignificant) return best;
      std::vector<Score> order = scores.best;
      std::sort(order.begin(), order.end(), [](const Score& a, const Score& b) { return a.gain > b.gain; });
      std::vector<Effects> tries;
      for (std::size_t i = 0; i < std::min<std::size_t>(4, order.size()); ++i) {
        Effects wanted = best.effects;
        wanted.push_back(begin(order[i]));
        tries.push_back(wanted);
      }
      if (effects == 2) add_pairs(tries);
      const Fitted found = best_of(tries);
      if (!accepted(found, best, kLeastPairShare)) return best;
      best = found;
    }
    return best;
  }

  void add_pairs(std::vector<Effects>& tries) const {
    for (std::size_t i = 0; i < std::min(kPaired, singles_.size()); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Effects pair{singles_[i].effects[0], singles_[j].effects[0]};
        if (std::none_of(tries.begin(), tries.end(), [&](const Effects& known) { return same(known, pair); }))
          tries.push_back(pair);
      }
  }

  Fitted best_of(const std::vector<Effects>& tries) {
    Fitted best;
    double least = INFINITY;
    for (const Effects& effects : tries) {
      Fitted fitted = study_.fit(effects);
      rank(fitted, 1);
      all_.push_back(fitted);
      if (value(fitted) < least) least = value(fitted), best = std::move(fitted);
    }
    return best;
  }

  /// How often resampling the blocks picks each hypothesis of the winner's size.
  [[nodiscard]] std::vector<double> frequencies(const std::vector<const Fitted*>& rivals) const {
    std::vector<double> picked(rivals.size(), 0.0);
    std::mt19937_64 random(request_.seed + 17);
    const std::size_t train = rivals[0]->train.blocks.size(), count = train + rivals[0]->test.blocks.size();
    for (int i = 0; i < kVotes; ++i) {
      std::vector<double> total(rivals.size());
      for (std::size_t r = 0; r < rivals.size(); ++r)
        total[r] = price() * static_cast<double>(rivals[r]->parameters);
      for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = static_cast<std::size_t>(random() % count);
        for (std::size_t r = 0; r < rivals.size(); ++r)
          total[r] += at < train ? rivals[r]->train.blocks[at] : rivals[r]->test.blocks[at - train];
      }
      const auto winner = std::min_element(total.begin(), total.end()) - total.begin();
      picked[static_cast<std::size_t>(winner)] += 1.0 / kVotes;
    }
    return picked;
  }

  void conclude(const Fitted& best) {
    request_.progress(0.88, "what is left");
    const std::vector<Unexplained> left = find_unexplained(study_, best.effects, best.train);
    const double explained = base_.train.loss - best.train.loss;
    double doubtful = 0;
    const double excess =
        std::max(mean_square(best.train.load) / kWorstSwing, mean_square(best.train.drive) / kWorstDrive);
    if (excess > 1) {
      result_.remainder.predictable_fraction = 1 - 1 / excess;
      result_.remainder.from.emplace_back(mean_square(best.train.load) > kWorstSwing
                                              ? "swing: more than sensor noise and a coloured force leave"
                                              : "drives: more than sensor noise and a coloured force leave");
    } else if (!left.empty()) {
      result_.remainder.predictable_fraction = left[0].fraction;
      for (std::size_t i = 0; i < std::min<std::size_t>(3, left.size()); ++i)
        result_.remainder.from.push_back(left[i].variable);
      doubtful = left[0].gain;
    }
    const bool something = !left.empty() && left[0].fraction > kPatternShare;
    if (best.effects.empty()) {
      result_.verdict = something || excess > 1 ? Verdict::unknown : Verdict::none;
    } else if (excess > 1 ||
               (something && (doubtful > kDoubtful * explained || left[0].fraction > kDoubtful))) {
      result_.verdict = Verdict::unknown;
    } else {
      name(best);
    }
    if (result_.verdict != Verdict::none) report_causes(best);
    request_.progress(0.93, "held-out runs");
    result_.held_out = held_out(rig_, study_, test_, best.effects, request_.seed);
    if (!rivals_.empty()) propose(best);
    result_.traces = traces(test_, study_.base(), study_.with(best.effects));
    for (const Effect& effect : best.effects)
      result_.extension.push_back(effect.candidate->setting(effect.values));
    say();
    request_.progress(1, "done");
  }

  void name(const Fitted& best) {
    std::vector<const Fitted*> rivals;
    for (const Fitted& fitted : all_)
      if (fitted.effects.size() == best.effects.size() && accepted(fitted, base_, kLeastShare))
        rivals.push_back(&fitted);
    const std::vector<double> picked = frequencies(rivals);
    for (std::size_t r = 0; r < rivals.size(); ++r)
      for (const Effect& effect : rivals[r]->effects) frequency_[effect.candidate] += picked[r];
    bool clear = true, known = true;
    for (const Effect& effect : best.effects) {
      clear = clear && frequency_[effect.candidate] >= kClearWin;
      known = known && effect.candidate->changes_known_parameter;
    }
    for (const auto& [candidate, share] : frequency_)
      if (share >= kRunnerUp && !holds(best.effects, candidate)) rivals_.push_back(candidate);
    result_.verdict = !clear && !rivals_.empty() ? Verdict::ambiguous
                      : known                    ? Verdict::parameter
                                                 : Verdict::named;
    if (result_.verdict != Verdict::ambiguous) rivals_.clear();
    std::sort(rivals_.begin(), rivals_.end(),
              [&](const Candidate* a, const Candidate* b) { return frequency_[a] > frequency_[b]; });
    for (const Candidate* rival : rivals_)
      if (std::find(result_.ambiguous_with.begin(), result_.ambiguous_with.end(), rival->cause) ==
          result_.ambiguous_with.end())
        result_.ambiguous_with.push_back(rival->cause);
  }

  /// The motion that tells the first effect from its strongest rival; what the best model leaves is the
  /// noise.
  void propose(const Fitted& best) {
    const Candidate* rival = rivals_[0];
    const auto single = std::find_if(singles_.begin(), singles_.end(),
                                     [&](const Fitted& f) { return f.effects[0].candidate == rival; });
    if (single == singles_.end()) return;
    std::array<double, kOutputs> noise{};
    for (std::size_t i = 0; i < kOutputs; ++i) {
      const auto found = result_.held_out.noise.find(kOutputNames[i]);
      noise[i] = found == result_.held_out.noise.end() ? 1e-3 : found->second;
    }
    request_.progress(0.95, "which motion would tell them apart");
    result_.next_experiment = propose_experiment(rig_, *best.effects[0].candidate, best.effects[0].values,
                                                 *rival, single->effects[0].values, noise);
  }

  void report_causes(const Fitted& best) {
    std::size_t i = 0;
    for (const Effect& effect : best.effects) {
      Cause cause{effect.candidate->cause, effect.candidate->axis, {}, 1, 0};
      for (std::size_t k = 0; k < effect.values.size(); ++k, ++i)
        cause.parameters.push_back({effect.candidate->parameters[k].name,
                                    effect.candidate->parameters[k].unit, effect.values[k], best.std_dev[i]});
      for (const Ranked& ranked : result_.ranking)
        if (ranked.label == effect.candidate->label()) cause.p_value = ranked.p_value;
      const auto found = frequency_.find(effect.candidate);
      cause.resampling_frequency = found == frequency_.end() ? 0 : found->second;
      result_.causes.push_back(cause);
    }
    for (Ranked& ranked : result_.ranking)
      for (const auto& [candidate, share] : frequency_)
        if (candidate->label() == ranked.label) ranked.resampling_frequency = share;
    std::stable_sort(result_.ranking.begin(), result_.ranking.end(), [](const Ranked& a, const Ranked& b) {
      return a.train_gain + a.test_gain > b.train_gain + b.test_gain;
    });
  }

  void say() {
    std::string names, rivals;
    for (const Cause& cause : result_.causes)
      names +=
          (names.empty() ? "" : " and ") + cause.name + (cause.axis.empty() ? "" : " (" + cause.axis + ")");
    for (const std::string& rival : result_.ambiguous_with) rivals += (rivals.empty() ? "" : ", ") + rival;
    switch (result_.verdict) {
      case Verdict::none:
        result_.sentence = "Nothing that these data could show is wrong with the model.";
        break;
      case Verdict::named:
        result_.sentence = "The simulation lacks " + names + ".";
        break;
      case Verdict::parameter:
        result_.sentence = "A parameter of the model is off: " + names + ".";
        break;
      case Verdict::ambiguous:
        result_.sentence = "These data cannot tell " + names + " from " + rivals + ".";
        break;
      case Verdict::unknown:
        result_.sentence =
            "Something is wrong that no known cause explains" +
            (result_.remainder.from.empty() ? std::string{"."}
                                            : "; it goes with " + result_.remainder.from[0] + ".");
        break;
    }
  }

  const runtime::Rig& rig_;
  const Runs& test_;
  const Request& request_;
  Study study_;
  Fitted base_;
  std::vector<Fitted> singles_, all_;
  std::map<const Candidate*, double> frequency_;
  std::vector<const Candidate*> rivals_;
  Diagnosis result_;
};

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

}  // namespace

const char* name_of(Verdict verdict) {
  return std::array{"none", "named", "ambiguous", "parameter", "unknown"}[static_cast<std::size_t>(verdict)];
}

Diagnosis diagnose(const runtime::Rig& rig, std::vector<Run> train, std::vector<Run> test,
                   const Request& request) {
  const auto begin = std::chrono::steady_clock::now();
  const Runs training = prepared(std::move(train), rig), testing = prepared(std::move(test), rig);
  require_excitation(training, rig);
  Diagnosis result = Search(rig, training, testing, request).run();
  result.runtime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace crane::diagnosis
