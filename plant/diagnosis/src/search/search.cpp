#include "search/search.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "rules.hpp"
#include "search/compare.hpp"
#include "search/drive_pairs.hpp"
#include "search/initial_values.hpp"
#include "search/parts.hpp"
#include "search/prospects.hpp"
#include "search/score_tests.hpp"
#include "search/selection.hpp"

namespace crane::diagnosis {
namespace {

/// Number of candidates that are fitted in addition to the base model (kFirst) and to each hypothesis of a
/// beam (kExtensions).
constexpr std::size_t kFirst = 10, kExtensions = 5;
/// Number of hypotheses of one size that are extended, because the best single effect need not be part of the
/// best pair.
constexpr std::size_t kBeam = 2;
/// Number of best single effects of which all pairs are fitted, because a pair may explain what neither
/// effect explains.
constexpr std::size_t kPaired = 3;
/// Number of pairs of one drive that are fitted because they describe the equation error best.
constexpr std::size_t kDrivePairs = 3;
/// Number of candidates that replace an effect in turn.
constexpr std::size_t kExchanged = 2;

Effects and_one(Effects effects, const Candidate* candidate) {
  effects.push_back({candidate, {}});
  return effects;
}

class Search {
 public:
  Search(const Study& study, const BaseModel& base, const Request& request)
      : study_(study), base_(base), request_(request) {
    found_.base = found_.best = base_in(base.calibrated);
  }

  Hypotheses run() {
    request_.progress(0.05, "scores of all candidates");
    // The fitted inaccuracies absorb a part of a missing effect. A fit of this effect beside them then finds
    // too small a value. Effects are therefore also fitted beside the unchanged values of the rig file.
    record_detection(score_tests_.beside(WhitenedData(study_, base_.calibrated), found_.base));
    if (!base_.exact.inaccuracies.empty()) extend(base_in(base_.exact), kFirst);
    extend(found_.base, kFirst);
    Hypotheses& found = found_;
    std::vector<Fitted> level = refit_likeliest();
    if (level.empty()) return finished();
    if (accept_one_of(level)) {
      // With the noise of the best hypothesis, the predictions of the score test are closer.
      extend_towards(found.best, base_in(found.best.nuisance), kFirst);
      level = merged(std::move(level), refit_likeliest());
      accept_one_of(level);
      while (level.front().effects.size() < request_.most_effects) {
        const std::size_t size = level.front().effects.size();
        if (size == 1) try_pairs(level);
        for (std::size_t i = 0; i < std::min(kBeam, level.size()); ++i) {
          request_.progress(share_done(size, i), "search for a further cause");
          const double p_value = extend_towards(found.best, level[i], kExtensions);
          if (i == 0 && p_value > rules::kSignificant && found.best.deviance.size() >= kFewBlocks) break;
        }
        level = refit_likeliest();
        if (level.empty()) break;
        refit_parts_of_first(level);
        if (less(level.front(), found.best)) level = merged(std::move(level), exchanged(level.front()));
        if (!accept_one_of(level)) break;
      }
    }
    while (found.best.effects.size() > 1 && drop_one()) {
    }
    try_alike();
    return finished();
  }

 private:
  Hypotheses finished() {
    Hypotheses& found = found_;
    found.base.train = WhitenedData(study_, found.best.nuisance).base();
    for (const Fitted& fitted : found.all) rank(fitted);
    return std::move(found_);
  }

  /// The base model with other nuisance parameters.
  [[nodiscard]] Fitted base_in(const Nuisance& nuisance) const {
    return base_fit(WhitenedData(study_, nuisance));
  }

  [[nodiscard]] Fitted refitted(const Fitted& first_fit) const {
    return refit_with_own_noise(study_, base_, first_fit);
  }

  /// Fit of effects of which none was fitted. @param nuisance of a hypothesis that contains them
  [[nodiscard]] Fitted fitted_in(const Nuisance& nuisance, const Effects& effects) const {
    const WhitenedData data(study_, nuisance);
    return refitted(first_fit(data, effects, base_fit(data)));
  }

  /// Refits every hypothesis that lacks one effect of `given`, from the values of `given`. The search need
  /// not have reached these hypotheses from the base model.
  void refit_parts_of(const Fitted& given) {
    const Fitted whole = given;
    for (std::size_t i = 0; i < whole.effects.size(); ++i) {
      const Effects rest = without(whole.effects, i);
      const Fitted fitted = fitted_in(whole.nuisance, rest);
      keep(found_.all, fitted);
      if (rest.size() == found_.best.effects.size()) accept(fitted);
    }
    for (Fitted& fitted : found_.all)
      if (fitted.effects.size() == whole.effects.size())
        fitted = no_worse_than_its_parts(study_, base_, found_.all, fitted);
  }

  /// Refits the parts of the likeliest hypothesis. The hypotheses that contain these parts may become
  /// likelier, so that another one is first; its parts are refitted as well.
  void refit_parts_of_first(std::vector<Fitted>& level) {
    Effects refitted;
    for (std::size_t round = 0; round < level.size() && !same(refitted, level.front().effects); ++round) {
      refitted = level.front().effects;
      refit_parts_of(level.front());
      for (Fitted& fitted : level) fitted = *find(found_.all, fitted.effects);
      std::sort(level.begin(), level.end(), less);
    }
  }

  /// Hypotheses in which another effect replaces one effect of `given`, because the best candidate beside few
  /// effects need not be the best beside all.
  /// @pre refit_parts_of(given)
  std::vector<Fitted> exchanged(const Fitted& given) {
    const Fitted whole = given;
    for (std::size_t i = 0; i < whole.effects.size(); ++i) {
      const Effects rest = without(whole.effects, i);
      if (const Fitted* part = find(found_.all, rest)) extend_towards(whole, *part, kExchanged);
    }
    return refit_likeliest();
  }

  /// Fits the hypotheses in which a candidate with the same effect on the data replaces an effect of the best
  /// one. The likeliest can become the best one; the others are possible rivals in the vote.
  void try_alike() {
    const Fitted whole = found_.best;
    for (std::size_t i = 0; i < whole.effects.size(); ++i) {
      const std::vector<const Candidate*> others =
          alike(*whole.effects[i].candidate, study_.candidates(), found_.excitation);
      const Effects rest = without(whole.effects, i);
      if (std::ranges::all_of(others, [&](const Candidate* other) {
            return has(rest, other) || known(and_one(rest, other));
          }))
        continue;
      const Fitted* part = rest.empty() ? &found_.base : find(found_.all, rest);
      extend(part != nullptr ? *part : fitted_in(whole.nuisance, rest), 0, others);
    }
    accept_one_of(refit_likeliest());
  }

  /// With fewer blocks, the sign-flip test of a hypothesis with effects is unreliable, and the second
  /// hypothesis of the beam is always extended.
  static constexpr std::size_t kFewBlocks = 60;

  [[nodiscard]] double share_done(std::size_t size, std::size_t i) const {
    const double level = static_cast<double>(size) + static_cast<double>(i) / static_cast<double>(kBeam);
    return 0.2 + 0.6 * level / static_cast<double>(request_.most_effects);
  }

  /// Fits the strongest candidates, and those in `always`, in addition to the effects of `given`. If a
  /// hypothesis leaves a line in the swing, a cause that adds a natural frequency is fitted as well: the
  /// noise model describes the line as a disturbance, and the score test hardly sees it.
  /// @return p value of the largest score; the level of a line, if the hypothesis leaves one
  /// @param needed decrease of the deviance; a candidate that cannot reach it is fitted only if it is in
  ///   `always`
  double extend(const Fitted& given, std::size_t count, std::vector<const Candidate*> always = {},
                double needed = 0) {
    const Fitted there = given;  // `all` grows
    const WhitenedData data(study_, there.nuisance);
    ScoreTable scores = score_tests_.beside(data, there);
    const std::vector<const Candidate*> ringing =
        initial_values_.add_of_lines(data, there, request_.seed, scores);
    always.insert(always.end(), ringing.begin(), ringing.end());
    if (!there.effects.empty() && scores.p_value > rules::kSignificant) {
      if (ringing.empty()) return scores.p_value;
      count = 0;
    }
    std::vector<Score> left, wanted;
    for (const Score& score : scores.best) {
      const Candidate* candidate = &study_.candidates()[score.candidate];
      if (!there.effects.empty() && known(and_one(there.effects, candidate))) continue;
      (std::ranges::find(always, candidate) != always.end() ? wanted : left).push_back(score);
    }
    for (const Score& score : strongest(std::move(left), count, std::move(wanted))) {
      const Candidate& candidate = study_.candidates()[score.candidate];
      const bool required = std::ranges::find(always, &candidate) != always.end();
      if (!required && reachable_decrease(score, candidate, there) < needed) continue;
      const Effects start = initial_values_.of(data, there, score);
      if (there.effects.empty()) request_.progress(0.1, "fit of " + candidate.label());
      tried_.push_back(first_fit(data, initial_values_.with_new_wave(data, start, there), there));
    }
    return ringing.empty() ? scores.p_value : rules::kSignificant.value;
  }

  /// Keeps the scores of the calibrated base model in its own noise. In the noise of a hypothesis, the scores
  /// would also test what this hypothesis describes.
  void record_detection(const ScoreTable& scores) {
    found_.detection_p_value = scores.p_value;
    found_.excitation = scores.excitation;
    for (const Score& score : scores.best) p_value_[score.candidate] = score.p_value;
  }

  /// Fits only those of the strongest candidates that may make `given` as likely as `best`.
  double extend_towards(const Fitted& best, const Fitted& given, std::size_t count) {
    return extend(given, count, {}, distance_from(best, given));
  }

  /// Fits the pairs of the best single effects, and the pairs that describe the equation error of a drive
  /// best.
  void try_pairs(const std::vector<Fitted>& singles) {
    const WhitenedData data(study_, found_.best.nuisance);
    const Fitted base = base_fit(data);
    for (std::size_t i = 0; i < std::min(kPaired, singles.size()); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Effects pair{singles[i].effects[0], singles[j].effects[0]};
        if (!known(pair)) tried_.push_back(first_fit(data, pair, base));
      }
    for (const Effects& pair :
         strongest_drive_pairs(data, base.train, score_tests_.probe_slopes(), kDrivePairs))
      if (!known(pair)) tried_.push_back(first_fit(data, pair, base));
  }

  /// Refits the tried hypotheses that are worth it with their own noise.
  /// @return in the order of decreasing likelihood
  std::vector<Fitted> refit_likeliest() {
    std::vector<Fitted> level;
    for (const Fitted& tried : worth_a_refit(std::exchange(tried_, {}), found_.base, found_.best))
      level.push_back(no_worse_than_its_parts(study_, base_, found_.all, refitted(tried)));
    std::sort(level.begin(), level.end(), less);
    for (const Fitted& fitted : level) keep(found_.all, fitted);
    return level;
  }

  [[nodiscard]] bool known(const Effects& effects) const {
    return find(found_.all, effects) != nullptr || find(tried_, effects) != nullptr;
  }

  /// Replaces the best hypothesis by `fitted`. If `fitted` is no larger (same number of effects, or no more
  /// values), it must be likelier, and accepted against the base model. If it is larger, it must be accepted
  /// against the best hypothesis. @return true when it is replaced
  bool accept(const Fitted& fitted) {
    const Fitted& best = found_.best;
    const bool no_larger =
        fitted.effects.size() == best.effects.size() || fitted.parameters <= best.parameters;
    if (no_larger && !less(fitted, best)) return false;
    if (!accepted(fitted, no_larger ? found_.base : best, study_.candidates().size())) return false;
    found_.best = fitted;
    return true;
  }

  /// Accepts the likeliest acceptable hypothesis of the list. @return whether there is one
  bool accept_one_of(const std::vector<Fitted>& level) {
    return std::ranges::any_of(level, [&](const Fitted& fitted) { return accept(fitted); });
  }

  /// Removes one effect that is not accepted beside the others. @return whether there was one
  bool drop_one() {
    const Fitted whole = found_.best;
    const Fitted* dropped = nullptr;
    std::vector<Fitted> fewer;
    for (std::size_t i = 0; i < whole.effects.size(); ++i) {
      const Effects rest = without(whole.effects, i);
      if (const Fitted* fitted = find(found_.all, rest)) {
        fewer.push_back(*fitted);
        continue;
      }
      const WhitenedData data(study_, found_.base.nuisance);
      fewer.push_back(refitted(first_fit(data, rest, found_.base)));
      keep(found_.all, fewer.back());
    }
    for (const Fitted& one : fewer)
      if (!accepted(whole, one, study_.candidates().size()) && (dropped == nullptr || less(one, *dropped)))
        dropped = &one;
    if (dropped == nullptr) return false;
    found_.best = *dropped;
    return true;
  }

  void rank(const Fitted& f) {
    Ranked& ranked = found_.ranking.emplace_back(ranked_against(found_.base, f));
    if (f.effects.size() != 1) return;
    const auto known =
        p_value_.find(static_cast<std::size_t>(f.effects[0].candidate - study_.candidates().data()));
    ranked.p_value = known == p_value_.end() ? 1 : known->second;
  }

  const Study& study_;
  const BaseModel& base_;
  const Request& request_;
  Hypotheses found_;
  ScoreTests score_tests_{request_.seed};
  std::vector<Fitted> tried_;  ///< first fits that have not been refitted
  InitialValues initial_values_;
  std::map<std::size_t, double> p_value_;  ///< of every candidate alone
};

}  // namespace

Hypotheses searched(const Study& study, const BaseModel& base, const Request& request) {
  return Search(study, base, request).run();
}

}  // namespace crane::diagnosis
