#include "verdict/judgement.hpp"

#include <algorithm>
#include <map>

#include "force/force_lines.hpp"
#include "robust.hpp"
#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

/// Mean loss of the whitened residual beyond which noise and a coloured force cannot have made it. Swing
/// keeps to 1 within a few percent, a drive that breaks loose a moment too late or early to 1.48, to more
/// where a sensor of the swing that pulls at it is wrong.
constexpr double kWorstSwing = 1.25, kWorstDrive = 1.5, kWorstBesideSwing = 1.75;
constexpr double kClearWin = 0.8;
constexpr double kRunnerUp = 0.1;
/// Share of the drives' loss beyond which an unexplained pattern is taken seriously: the right model leaves
/// up to 0.3 percent.
constexpr double kPattern = 0.004;
/// What goes beside a named cause: its form is not exactly the term's. A pattern this large against what the
/// named effects explain, or against the whole loss, makes the name doubtful.
constexpr double kDoubtful = 0.05;

/// 1 where noise and disturbance are as learnt.
double mean_loss(const Fits& fits) {
  double sum = 0, count = 0;
  for (const WindowFit& fit : fits)
    sum += loss_of(fit.residual), count += static_cast<double>(fit.residual.size());
  return count > 0 ? sum / (kMeanLoss * count) : 0;
}

/// Mean loss of what the best hypothesis leaves, in the most that noise and a coloured force can make.
double excess(const Fitted& best) {
  const bool of_swing = std::any_of(best.effects.begin(), best.effects.end(),
                                    [](const Effect& e) { return e.candidate->load && !e.candidate->drive; });
  return std::max(mean_loss(best.train.load) / kWorstSwing,
                  mean_loss(best.train.drive) / (of_swing ? kWorstBesideSwing : kWorstDrive));
}

std::string said(const Diagnosis& d) {
  std::string names, rivals;
  for (const Cause& cause : d.causes)
    names +=
        (names.empty() ? "" : " and ") + cause.name + (cause.axis.empty() ? "" : " (" + cause.axis + ")");
  for (const std::string& rival : d.ambiguous_with) rivals += (rivals.empty() ? "" : ", ") + rival;
  switch (d.verdict) {
    case Verdict::none:
      return "Nothing that these data could show is wrong with the model.";
    case Verdict::named:
      return "The simulation lacks " + names + ".";
    case Verdict::parameter:
      return "A parameter of the model is off: " + names + ".";
    case Verdict::ambiguous:
      return "These data cannot tell " + names + " from " + rivals + ".";
    case Verdict::unknown:
      break;
  }
  const auto& from = d.remainder.from;
  return "Something is wrong that no known cause explains" +
         (from.empty() ? std::string{"."} : " (" + from[0] + ").");
}

class Judgement {
 public:
  Judgement(const Study& study, const Hypotheses& hypotheses, std::uint64_t seed)
      : study_(study), all_(hypotheses), best_(hypotheses.best), seed_(seed) {
    result_.ranking = hypotheses.ranking;
    result_.detection_p_value = hypotheses.detection_p_value;
  }

  Judged run() {
    const bool doubted = doubt();
    if (best_.effects.empty())
      result_.verdict = doubted ? Verdict::unknown : Verdict::none;
    else if (doubted)
      result_.verdict = Verdict::unknown;
    else
      name();
    if (result_.verdict != Verdict::none) report_causes();
    result_.sentence = said(result_);
    return {std::move(result_), std::move(rivals_)};
  }

 private:
  /// Whether what is left is too much to be believed; says what it goes with.
  bool doubt() {
    const double too_much = excess(best_);
    const std::vector<Unexplained> left = what_is_left();
    Remainder& remainder = result_.remainder;
    if (too_much > 1) {
      remainder.predictable_fraction = 1 - 1 / too_much;
      remainder.from.emplace_back(mean_loss(best_.train.load) > kWorstSwing
                                      ? "more in the swing than sensor noise and a coloured force leave"
                                      : "more in the drives than sensor noise and a coloured force leave");
      return true;
    }
    if (left.empty()) return false;
    remainder.predictable_fraction = left[0].fraction;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, left.size()); ++i)
      remainder.from.push_back(left[i].variable);
    const double explained = all_.base.train.loss - best_.train.loss;
    return std::any_of(left.begin(), left.end(), [&](const Unexplained& u) {
      const bool counts = u.of_load || u.fraction > kPattern;
      return counts && (best_.effects.empty() || u.gain > kDoubtful * explained || u.fraction > kDoubtful);
    });
  }

  /// Patterns in the residual of the drives and lines in that of the swing, strongest first.
  [[nodiscard]] std::vector<Unexplained> what_is_left() const {
    std::vector<Unexplained> left = find_unexplained(study_.drive(), best_.train.drive);
    for (const auto& [problem, fits] :
         {std::pair{&study_.drive(), &best_.train.drive}, {&study_.load(), &best_.train.load}})
      for (const Unexplained& line : find_force_lines(*problem, *fits, seed_)) left.push_back(line);
    std::sort(left.begin(), left.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
    return left;
  }

  /// Who wins among all accepted hypotheses of the best one's size.
  void name() {
    std::vector<const Fitted*> equals;
    for (const Fitted& fitted : all_.all)
      if (fitted.effects.size() == best_.effects.size() && !same(fitted.effects, best_.effects) &&
          accepted(fitted, all_.base, seed_))
        equals.push_back(&fitted);
    const std::vector<double> picked = frequencies(best_, equals, seed_);
    double left = 1;
    for (std::size_t r = 0; r < equals.size(); ++r) {
      left -= picked[r];
      for (const Effect& effect : equals[r]->effects) frequency_[effect.candidate] += picked[r];
    }
    for (const Effect& effect : best_.effects) frequency_[effect.candidate] += left;
    bool clear = true, known = true;
    for (const Effect& effect : best_.effects) {
      clear = clear && frequency_[effect.candidate] >= kClearWin;
      known = known && effect.candidate->changes_known_parameter;
    }
    for (const auto& [candidate, share] : frequency_)
      if (share >= kRunnerUp && !has(best_.effects, candidate)) rivals_.push_back(candidate);
    result_.verdict = !clear && !rivals_.empty() ? Verdict::ambiguous
                      : known                    ? Verdict::parameter
                                                 : Verdict::named;
    if (result_.verdict != Verdict::ambiguous) rivals_.clear();
    std::sort(rivals_.begin(), rivals_.end(),
              [&](const Candidate* a, const Candidate* b) { return frequency_[a] > frequency_[b]; });
    auto& names = result_.ambiguous_with;
    for (const Candidate* rival : rivals_)
      if (std::find(names.begin(), names.end(), rival->cause) == names.end()) names.push_back(rival->cause);
  }

  void report_causes() {
    for (const Effect& effect : best_.effects) {
      Cause cause{effect.candidate->cause, effect.candidate->axis, {}, 1, 0};
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

  const Study& study_;
  const Hypotheses& all_;
  const Fitted& best_;
  std::uint64_t seed_;
  std::map<const Candidate*, double> frequency_;
  std::vector<const Candidate*> rivals_;
  Diagnosis result_;
};

}  // namespace

void doubt(Diagnosis& diagnosis, const std::string& why) {
  diagnosis.verdict = Verdict::unknown;
  diagnosis.ambiguous_with.clear();
  diagnosis.remainder.from.insert(diagnosis.remainder.from.begin(), why);
  diagnosis.sentence = said(diagnosis);
}

Judged judge(const Study& study, const Hypotheses& hypotheses, std::uint64_t seed) {
  return Judgement(study, hypotheses, seed).run();
}

}  // namespace crane::diagnosis
