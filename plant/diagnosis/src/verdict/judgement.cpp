#include "verdict/judgement.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "force/force_lines.hpp"
#include "force/jumps.hpp"
#include "robust.hpp"
#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

/// Mean loss of the whitened residual beyond which noise and a coloured force cannot have made it: they keep
/// to 1 within a few percent.
constexpr double kWorst = 1.25;
constexpr double kClearWin = 0.8;
constexpr double kRunnerUp = 0.1;
/// Share of the drives' loss beyond which an unexplained pattern is taken seriously: the right model leaves
/// up to 0.4 percent.
constexpr double kPattern = 0.008;
/// Luck makes patterns of so many noise variances, in short data as in long.
constexpr double kLuck = 15;
/// A pattern this large against all that is wrong with the base model makes the names beside it doubtful. A
/// term's form is not exactly the effect's, so that more may be left of what it is a law of. Several laws of
/// the same take any form together.
constexpr double kDoubtful = 0.04, kDoubtfulOfItsOwn = 0.1, kDoubtfulOfSeveralLaws = 0.01;
/// No term of a drive changes with time.
constexpr double kDoubtfulOverTime = 0.01;
/// So does one that is this large against what one of the names explains on its axis: it may be there for
/// what is left.
constexpr double kDoubtfulOfOneName = 0.5;

/// 1 where noise and disturbance are as learnt.
double mean_loss(const Fits& fits) {
  double sum = 0, count = 0;
  for (const WindowFit& fit : fits)
    sum += loss_of(fit.residual), count += static_cast<double>(fit.residual.size());
  return count > 0 ? sum / (kMeanLoss * count) : 0;
}

double squares_of(const std::vector<Eigen::VectorXd>& residuals) {
  double sum = 0;
  for (const Eigen::VectorXd& residual : residuals) sum += residual.squaredNorm();
  return sum;
}

/// Whether the pattern goes with what the term is a law of.
bool of_its_own(const Candidate& candidate, const Unexplained& left) {
  using enum GoesWith;
  static const std::map<std::string, GoesWith> kLaws{
      {"coulomb_friction", speed},    {"viscous_friction", speed}, {"stribeck_friction", speed},
      {"direction_asymmetry", speed}, {"backlash", jumps},         {"position_dependent_friction", position},
      {"torque_ripple", position}};
  const auto laws = kLaws.find(candidate.cause);
  return laws != kLaws.end() && candidate.axis == axis_of(left.output) && left.with == laws->second;
}

/// A pattern, and in the same noise the squares of the base model and what the weakest of the names on its
/// axis takes off them.
struct Pattern {
  Unexplained what;
  double of_base = 0, of_weakest = std::numeric_limits<double>::infinity();
};

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
    const double load = mean_loss(best_.train.load), drives = mean_loss(best_.train.drive);
    Remainder& remainder = result_.remainder;
    if (std::max(load, drives) > kWorst) {
      remainder.predictable_fraction = 1 - kWorst / std::max(load, drives);
      remainder.from.push_back(std::string{load > kWorst ? "more in the swing" : "more in the drives"} +
                               " than sensor noise and a coloured force leave");
      return true;
    }
    const std::vector<Pattern> left = what_is_left();
    if (left.empty()) return false;
    remainder.predictable_fraction = left[0].what.fraction;
    for (std::size_t i = 0; i < std::min<std::size_t>(3, left.size()); ++i)
      remainder.from.push_back(left[i].what.variable);
    return std::any_of(left.begin(), left.end(), [&](const Pattern& pattern) {
      const Unexplained& u = pattern.what;
      const bool counts = u.with == GoesWith::frequency || (u.fraction > kPattern && u.gain > kLuck);
      return counts && (best_.effects.empty() || u.gain > believable(u) * pattern.of_base ||
                        u.gain > kDoubtfulOfOneName * pattern.of_weakest);
    });
  }

  /// Beside the named effects, as a share of the base model's loss.
  [[nodiscard]] double believable(const Unexplained& left) const {
    if (left.with == GoesWith::time) return kDoubtfulOverTime;
    const auto laws = std::count_if(best_.effects.begin(), best_.effects.end(), [&](const Effect& effect) {
      return of_its_own(*effect.candidate, left);
    });
    return laws == 0 ? kDoubtful : laws == 1 ? kDoubtfulOfItsOwn : kDoubtfulOfSeveralLaws;
  }

  /// Patterns in the residual of the drives and lines in that of the swing, strongest first.
  [[nodiscard]] std::vector<Pattern> what_is_left() const {
    std::vector<Pattern> left;
    const Runs& runs = study_.drive().runs();
    // What rings by itself is a line of its own.
    const Crane crane = study_.with(best_.effects);
    const bool rings = !plant::Model(crane.parameters, crane.terms).ringing_coordinates().empty();
    const Replays best = replays_of(runs, crane), base = replays_of(runs, study_.base());
    for (const Output axis : study_.drive().outputs()) {
      const Pieces pieces = pieces_of(runs, best, axis);
      const double of_base = squares_of(residuals_of(pieces, base));
      const std::vector<double> by_each = explained_by_each(pieces);
      const auto add = [&](const Unexplained& what) {
        left.push_back({what, of_base, weakest(by_each, what)});
      };
      for (const Unexplained& pattern : find_unexplained(pieces)) add(pattern);
      if (!rings)
        if (const auto line = find_force_line(pieces, seed_)) add(*line);
      if (const auto jumps = find_jumps(pieces)) add(*jumps);
    }
    for (std::size_t output = 0; output < study_.load().outputs().size(); ++output)
      if (const auto line = find_force_line(pieces_of(study_.load(), best_.train.load, output), seed_))
        left.push_back({*line, all_.base.train.load_loss});
    std::sort(left.begin(), left.end(),
              [](const Pattern& a, const Pattern& b) { return a.what.gain > b.what.gain; });
    return left;
  }

  /// Of each of the effects, what it takes off the squares of a drive's pieces; infinite on another axis.
  [[nodiscard]] std::vector<double> explained_by_each(const Pieces& pieces) const {
    std::vector<double> explained(best_.effects.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < explained.size(); ++i) {
      if (best_.effects[i].candidate->axis != axis_of(pieces.output)) continue;
      Effects others = best_.effects;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      explained[i] =
          squares_of(residuals_of(pieces, replays_of(*pieces.runs, study_.with(others)))) - pieces.squares();
    }
    return explained;
  }

  /// The least that any of the effects explains but those of whose own law the pattern is.
  [[nodiscard]] double weakest(const std::vector<double>& explained, const Unexplained& left) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < explained.size(); ++i)
      if (!of_its_own(*best_.effects[i].candidate, left)) least = std::min(least, explained[i]);
    return least;
  }

  /// Who wins among all hypotheses of the best one's size that explain something. One that the held-out data
  /// do not speak for by themselves may still be the cause, when it does better in all.
  void name() {
    std::vector<const Fitted*> equals;
    for (const Fitted& fitted : all_.all)
      if (fitted.effects.size() == best_.effects.size() && !same(fitted.effects, best_.effects) &&
          possible(fitted, all_.base, seed_))
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
                      : !all_.proven             ? Verdict::unknown
                      : known                    ? Verdict::parameter
                                                 : Verdict::named;
    auto& from = result_.remainder.from;
    if (result_.verdict == Verdict::unknown)
      from.insert(from.begin(), "held-out runs: too little in them to prove a cause");
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
