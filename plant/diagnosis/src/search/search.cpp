#include "search/search.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "rules.hpp"
#include "search/compare.hpp"

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
/// Number of candidates that replace an effect in turn.
constexpr std::size_t kExchanged = 2;
/// Largest number of hypotheses of one size that are refitted with their own noise: the first fits with the
/// largest likelihood.
constexpr std::size_t kRefitted = 4;

/// Strongest candidates: half of them by predicted share of the loss, half by p value. The score of a large
/// effect scatters from block to block, which raises its p value; in a rough residual the predicted share is
/// large by chance.
std::vector<Score> strongest(const ScoreTable& scores, std::size_t count) {
  std::vector<Score> left = scores.best, order;
  const auto take = [&](std::size_t up_to, auto&& before) {
    std::sort(left.begin(), left.end(), before);
    const std::size_t taken = std::min(up_to - order.size(), left.size());
    const auto end = left.begin() + static_cast<std::ptrdiff_t>(taken);
    order.insert(order.end(), left.begin(), end);
    left.erase(left.begin(), end);
  };
  take((count + 1) / 2, [](const Score& a, const Score& b) { return a.share > b.share; });
  take(count, [](const Score& a, const Score& b) { return a.p_value < b.p_value; });
  return order;
}

class Search {
 public:
  Search(Study& study, const Request& request) : study_(study), request_(request) {
    found_.base = found_.best = study.base_model();
  }

  Hypotheses run() {
    request_.progress(0.05, "scores of all candidates");
    extend(found_.base, kFirst);
    Hypotheses& found = found_;
    std::vector<Fitted> level = refit_likeliest();
    if (level.empty()) return finished();
    if (accept_one_of(level)) {
      // With the noise of the best hypothesis, the predictions of the score test are closer.
      extend(base_in(found.best.noise), kFirst);
      level = with(std::move(level), refit_likeliest());
      accept_one_of(level);
      while (level.front().effects.size() < request_.most_effects) {
        const std::size_t size = level.front().effects.size();
        if (size == 1) try_pairs(level);
        for (std::size_t i = 0; i < std::min(kBeam, level.size()); ++i) {
          request_.progress(share_done(size, i), "is there another effect?");
          const double p_value = extend(level[i], kExtensions);
          if (i == 0 && p_value > rules::kSignificant && found.best.deviance.size() >= kFewBlocks) break;
        }
        level = refit_likeliest();
        if (level.empty()) break;
        refit_parts_of_first(level);
        if (less(level.front(), found.best)) level = with(std::move(level), exchanged(level.front()));
        if (!accept_one_of(level)) break;
      }
    }
    while (found.best.effects.size() > 1 && drop_one()) {
    }
    return finished();
  }

 private:
  Hypotheses finished() {
    Hypotheses& found = found_;
    study_.whiten_with(found.best.noise);
    found.base.train = study_.base_train();
    for (const Fitted& fitted : found.all) rank(fitted);
    return std::move(found_);
  }

  /// The base model, whitened with another noise.
  [[nodiscard]] Fitted base_in(const Noise& noise) {
    study_.whiten_with(noise);
    return study_.base_model();
  }

  /// The hypotheses of both lists, each once, in the order of decreasing likelihood.
  static std::vector<Fitted> with(std::vector<Fitted> level, const std::vector<Fitted>& more) {
    level.insert(level.end(), more.begin(), more.end());
    std::sort(level.begin(), level.end(), less);
    std::vector<Fitted> once;
    for (const Fitted& fitted : level)
      if (std::ranges::none_of(once, [&](const Fitted& f) { return same(f.effects, fitted.effects); }))
        once.push_back(fitted);
    return once;
  }

  /// Refits every hypothesis that lacks one effect of `given`, from the values of `given`. The search need
  /// not have reached these hypotheses from the base model.
  void refit_parts_of(const Fitted& given) {
    const Fitted whole = given;
    for (std::size_t i = 0; i < whole.effects.size(); ++i) {
      Effects rest = whole.effects;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      study_.whiten_with(whole.noise);
      Fitted fitted = study_.refit_with_own_noise(study_.first_fit(rest, study_.base_model()));
      keep(fitted);
      if (rest.size() == found_.best.effects.size()) accept(fitted);
    }
    for (Fitted& fitted : found_.all)
      if (fitted.effects.size() == whole.effects.size()) fitted = no_worse_than_its_parts(fitted);
  }

  /// Refits the parts of the likeliest hypothesis. The hypotheses that contain these parts may become
  /// likelier, so that another one is first; its parts are refitted as well.
  void refit_parts_of_first(std::vector<Fitted>& level) {
    Effects refitted;
    for (std::size_t round = 0; round < level.size() && !same(refitted, level.front().effects); ++round) {
      refitted = level.front().effects;
      refit_parts_of(level.front());
      for (Fitted& fitted : level) fitted = *of_all(fitted.effects);
      std::sort(level.begin(), level.end(), less);
    }
  }

  /// Hypotheses in which another effect replaces one effect of `given`, because the best candidate beside few
  /// effects need not be the best beside all.
  /// @pre refit_parts_of(given)
  std::vector<Fitted> exchanged(const Fitted& given) {
    const Fitted whole = given;
    for (std::size_t i = 0; i < whole.effects.size(); ++i) {
      Effects rest = whole.effects;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      if (const auto part = of_all(rest); part != found_.all.end()) extend(*part, kExchanged);
    }
    return refit_likeliest();
  }

  /// With fewer blocks, sign flips do not test the residual of a hypothesis with effects.
  static constexpr std::size_t kFewBlocks = 60;

  [[nodiscard]] double share_done(std::size_t size, std::size_t i) const {
    const double level = static_cast<double>(size) + static_cast<double>(i) / static_cast<double>(kBeam);
    return 0.2 + 0.6 * level / static_cast<double>(request_.most_effects);
  }

  /// Fits the strongest candidates in addition to the effects of `given`. @return p value of the largest
  /// score
  double extend(const Fitted& given, std::size_t count) {
    const Fitted there = given;  // `all` grows
    study_.whiten_training(there.noise);
    const ScoreTable scores = study_.score(there.effects, there.train, request_.seed + there.effects.size());
    if (there.effects.empty()) {
      found_.detection_p_value = scores.p_value;
      found_.excitation = scores.excitation;
      for (const Score& score : scores.best) p_value_[score.candidate] = score.p_value;
    }
    if (!there.effects.empty() && scores.p_value > rules::kSignificant) return scores.p_value;
    for (const Score& score : strongest(scores, count)) {
      const Effects start = begin(there, score);
      if (!there.effects.empty() && known(start)) continue;
      if (there.effects.empty())
        request_.progress(0.1, "fit of " + study_.candidates()[score.candidate].label());
      tried_.push_back(study_.first_fit(with_fresh_wave(start, there), there));
    }
    return scores.p_value;
  }

  void try_pairs(const std::vector<Fitted>& singles) {
    study_.whiten_training(found_.base.noise);
    for (std::size_t i = 0; i < std::min(kPaired, singles.size()); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Effects pair{singles[i].effects[0], singles[j].effects[0]};
        if (!known(pair)) tried_.push_back(study_.first_fit(pair, found_.base));
      }
  }

  /// Refits the likeliest of the tried hypotheses with their own noise. @return in the order of decreasing
  /// likelihood
  std::vector<Fitted> refit_likeliest() {
    std::sort(tried_.begin(), tried_.end(),
              [](const Fitted& a, const Fitted& b) { return a.misfit < b.misfit; });
    tried_.resize(std::min(tried_.size(), kRefitted));
    std::vector<Fitted> level;
    for (const Fitted& tried : tried_)
      level.push_back(no_worse_than_its_parts(study_.refit_with_own_noise(tried)));
    tried_.clear();
    std::sort(level.begin(), level.end(), less);
    for (const Fitted& fitted : level) keep(fitted);
    return level;
  }

  /// At the values of a part, with amount 0 of the remaining effect, a hypothesis is as likely as the part. A
  /// less likely fit has stopped at another minimum; it is repeated from the values of the part.
  [[nodiscard]] Fitted no_worse_than_its_parts(const Fitted& given) {
    Fitted whole = given;
    for (std::size_t i = 0; i < given.effects.size() && given.effects.size() > 1; ++i) {
      Effects rest = given.effects;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      const auto found = of_all(rest);
      if (found == found_.all.end() || !likelier_without_penalty(*found, whole)) continue;
      const Fitted part = *found;
      Effect remaining = given.effects[i];
      for (std::size_t k = 0; k < remaining.candidate->amount_count; ++k) {
        // A term with inner coordinates has none at amount 0, which is outside its bounds.
        const FreeParameter& amount = remaining.candidate->parameters[k];
        remaining.values[k] = std::clamp(amount.null, amount.low, amount.high);
      }
      Effects start = part.effects;
      start.push_back(remaining);
      study_.whiten_training(part.noise);
      const Fitted again = study_.refit_with_own_noise(study_.first_fit(start, part));
      if (less(again, whole)) whole = again;
    }
    return whole;
  }

  [[nodiscard]] std::vector<Fitted>::iterator of_all(const Effects& effects) {
    return std::ranges::find_if(found_.all, [&](const Fitted& f) { return same(f.effects, effects); });
  }

  /// Adds a fit; of two fits of the same effects, the likelier one is kept.
  void keep(const Fitted& fitted) {
    const auto known = of_all(fitted.effects);
    if (known == found_.all.end())
      found_.all.push_back(fitted);
    else if (less(fitted, *known))
      *known = fitted;
  }

  [[nodiscard]] bool known(const Effects& effects) const {
    const auto is_there = [&](const Fitted& fitted) { return same(fitted.effects, effects); };
    return std::any_of(found_.all.begin(), found_.all.end(), is_there) ||
           std::any_of(tried_.begin(), tried_.end(), is_there);
  }

  /// Of hypotheses with the same number of effects, or with no more values, the likelier one is better. A
  /// larger hypothesis must be accepted against the best one.
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

  /// Initial values with the smallest loss. @param near fit of some of the effects
  [[nodiscard]] Effects best_start(const std::vector<Effects>& starts, const Fitted& near) const {
    if (starts.size() == 1) return starts[0];
    const Effects* best = &starts[0];
    double least = std::numeric_limits<double>::infinity();
    for (const Effects& start : starts)
      if (const double loss = study_.train(start, near.train).loss; loss < least) least = loss, best = &start;
    return *best;
  }

  /// The effects of `there` and the candidate of `score` with its best initial values. Values of a ringing
  /// cause are compared once only, because each comparison needs a fit of the starts of all windows.
  [[nodiscard]] Effects begin(const Fitted& there, const Score& score) {
    const Candidate* candidate = &study_.candidates()[score.candidate];
    const auto compared = ringing_start_.find(candidate);
    std::vector<std::vector<double>> values = score.starts;
    if (compared != ringing_start_.end()) values = {compared->second};
    std::vector<Effects> starts;
    for (const std::vector<double>& of_start : values) {
      starts.push_back(there.effects);
      starts.back().push_back({candidate, of_start});
    }
    const Effects best = best_start(starts, there);
    if (!candidate->ringing_starts.empty()) ringing_start_[candidate] = best.back().values;
    return best;
  }

  /// Initial values with a new wave: a scale of the sensor changes the positions at which the wave acts.
  [[nodiscard]] Effects with_fresh_wave(const Effects& effects, const Fitted& there) const {
    std::vector<Effects> starts{effects};
    for (std::size_t i = 0; i < effects.size(); ++i) {
      const Candidate& wave = *effects[i].candidate;
      if (!wave.waves) continue;
      Effects others = effects;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const auto moves_places = [&](const Effect& other) {
        return other.candidate->axis == wave.axis && other.candidate->load;
      };
      if (std::none_of(others.begin(), others.end(), moves_places)) continue;
      for (const Shape& shape : study_.shapes_of(wave, others)) {
        starts.push_back(effects);
        starts.back()[i].values = wave.begin(shape, shape.amounts);
      }
    }
    return best_start(starts, there);
  }

  /// Removes one effect that is not accepted beside the others. @return whether there was one
  bool drop_one() {
    const Fitted whole = found_.best;
    const Fitted* dropped = nullptr;
    std::vector<Fitted> fewer;
    for (std::size_t i = 0; i < whole.effects.size(); ++i) {
      Effects rest = whole.effects;
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
      const auto fitted = of_all(rest);
      if (fitted == found_.all.end()) study_.whiten_training(found_.base.noise);
      fewer.push_back(fitted != found_.all.end()
                          ? *fitted
                          : study_.refit_with_own_noise(study_.first_fit(rest, found_.base)));
    }
    for (const Fitted& one : fewer)
      if (!accepted(whole, one, study_.candidates().size()) && (dropped == nullptr || less(one, *dropped)))
        dropped = &one;
    if (dropped == nullptr) return false;
    found_.best = *dropped;
    return true;
  }

  void rank(const Fitted& f) {
    Ranked ranked;
    ranked.label = label_of(f.effects);
    ranked.parameters = estimates(f);
    ranked.train_gain = sum(found_.base.deviance) - sum(f.deviance);
    if (f.effects.size() == 1)
      ranked.p_value =
          p_value_[static_cast<std::size_t>(f.effects[0].candidate - study_.candidates().data())];
    found_.ranking.push_back(ranked);
  }

  Study& study_;
  const Request& request_;
  Hypotheses found_;
  std::vector<Fitted> tried_;                                      ///< first fits that have not been refitted
  std::map<const Candidate*, std::vector<double>> ringing_start_;  ///< the best one of each
  std::map<std::size_t, double> p_value_;                          ///< of every candidate alone
};

}  // namespace

Hypotheses searched(Study& study, const Request& request) { return Search(study, request).run(); }

}  // namespace crane::diagnosis
