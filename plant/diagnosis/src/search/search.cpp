#include "search/search.hpp"

#include <algorithm>
#include <limits>

#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

constexpr std::size_t kRefitted = 8;
constexpr std::size_t kPaired = 5;
constexpr std::size_t kExtensions = 6;
/// Singles that may take the place of one of several effects.
constexpr std::size_t kExchanged = 2;
/// A rival whose training loss will stay this much above the best one's does not win a resample.
constexpr double kHopeless = 30;
/// Flipping the signs of fewer blocks proves nothing about what is left beside a fitted effect.
constexpr std::size_t kFewBlocks = 60;

/// Half of them those that promise the largest share, half the surest ones: a large effect is as uneven from
/// block to block as it is large, and in a rough residual luck promises much.
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
  Search(const Study& study, const Request& request) : study_(study), request_(request) {
    found_.base.train = study.base_train();
    found_.base.test = study.base_test();
  }

  Hypotheses singles() {
    request_.progress(0.1, "scores of all candidates");
    const ScoreTable scores = study_.score({}, found_.base.train, request_.seed);
    found_.detection_p_value = scores.p_value;
    found_.excitation = scores.excitation;
    fit_singles(scores);
    choose();
    return std::move(found_);
  }

  Hypotheses singles_again(const Hypotheses& before) {
    found_.detection_p_value = before.detection_p_value;
    double least = std::numeric_limits<double>::infinity();
    const auto add = [&](const Effects& effects, double p_value) {
      found_.singles.push_back(study_.fit(effects, least + kHopeless));
      least = std::min(least, found_.singles.back().train.loss);
      rank(found_.singles.back(), p_value);
    };
    for (std::size_t i = 0; i < before.singles.size(); ++i)
      add(before.singles[i].effects, before.ranking[i].p_value);
    const ScoreTable scores = study_.score({}, found_.base.train, request_.seed);
    found_.excitation = scores.excitation;
    for (const Score& score : strongest(scores, kRefitted))
      if (const Effects effects = begin({}, score); !fitted_alone(effects)) add(effects, score.p_value);
    choose();
    return std::move(found_);
  }

  Hypotheses extended(const Hypotheses& singles) {
    found_ = singles;
    if (!found_.best.effects.empty() && found_.proven) extend();
    return std::move(found_);
  }

 private:
  void choose() {
    found_.all = found_.singles;
    found_.best = best_accepted(found_.singles, found_.base);
    found_.proven = true;
    if (!found_.best.effects.empty() || found_.detection_p_value > kSignificant) return;
    for (const Fitted& single : found_.singles)
      if ((found_.proven || less(single, found_.best)) && likely(single, found_.base, request_.seed))
        found_.best = single, found_.proven = false;
  }

  /// `before` when none is accepted in its place.
  [[nodiscard]] Fitted best_accepted(const std::vector<Fitted>& fitted, const Fitted& before) const {
    const Fitted* best = nullptr;
    for (const Fitted& one : fitted)
      if ((best == nullptr || less(one, *best)) && accepted(one, before, found_.base, request_.seed))
        best = &one;
    return best == nullptr ? before : *best;
  }

  /// What has been evaluated of some of the effects.
  [[nodiscard]] const Evaluation& near(const Effects& effects) const {
    const Effects& known = found_.best.effects;
    const bool all = std::all_of(known.begin(), known.end(),
                                 [&](const Effect& effect) { return has(effects, effect.candidate); });
    return all && !known.empty() ? found_.best.train : found_.base.train;
  }

  [[nodiscard]] Effects best_start(const std::vector<Effects>& starts) const {
    if (starts.size() == 1) return starts[0];
    const Effects* best = &starts[0];
    double least = std::numeric_limits<double>::infinity();
    for (const Effects& start : starts)
      if (const double loss = study_.train(start, near(start)).loss; loss < least)
        least = loss, best = &start;
    return *best;
  }

  /// `score`'s candidate beside what is there already, with those of its starts that do best.
  [[nodiscard]] Effects begin(const Effects& there, const Score& score) const {
    std::vector<Effects> starts;
    for (const std::vector<double>& values : score.starts) {
      starts.push_back(there);
      starts.back().push_back({&study_.candidates()[score.candidate], values});
    }
    return best_start(starts);
  }

  /// A wave goes over other places when the axis is elsewhere than its sensor says.
  [[nodiscard]] Effects with_fresh_wave(const Effects& effects) const {
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
    return best_start(starts);
  }

  [[nodiscard]] bool fitted_alone(const Effects& effects) const {
    return std::any_of(found_.singles.begin(), found_.singles.end(),
                       [&](const Fitted& single) { return same(single.effects, effects); });
  }

  void fit_singles(const ScoreTable& scores) {
    const std::vector<Score> order = strongest(scores, kRefitted);
    for (std::size_t i = 0; i < order.size(); ++i) {
      request_.progress(0.15 + 0.3 * static_cast<double>(i) / kRefitted,
                        "fit of " + study_.candidates()[order[i].candidate].label());
      found_.singles.push_back(study_.fit(begin({}, order[i]), found_.base.train.loss));
      rank(found_.singles.back(), order[i].p_value);
    }
  }

  void rank(const Fitted& f, double p_value) {
    Ranked ranked;
    ranked.label = label_of(f.effects);
    ranked.parameters = estimates(f);
    ranked.train_gain = found_.base.train.loss - f.train.loss;
    ranked.test_gain = found_.base.test.loss - f.test.loss;
    ranked.p_value = p_value;
    const auto known = std::find_if(found_.ranking.begin(), found_.ranking.end(),
                                    [&](const Ranked& r) { return r.label == ranked.label; });
    if (known == found_.ranking.end())
      found_.ranking.push_back(ranked);
    else if (ranked.train_gain > known->train_gain)
      ranked.p_value = known->p_value, *known = ranked;
  }

  /// Forward from the best, pairs of the best singles beside it.
  void extend() {
    for (std::size_t effects = 2; effects <= request_.most_effects; ++effects) {
      request_.progress(0.45 + 0.2 * static_cast<double>(effects - 2), "is there another effect?");
      const ScoreTable scores = study_.score(found_.best.effects, found_.best.train, request_.seed + effects);
      if (scores.p_value > kSignificant && blocks(found_.best) >= kFewBlocks) return;
      std::vector<Effects> tries;
      for (const Score& score : strongest(scores, kExtensions))
        tries.push_back(begin(found_.best.effects, score));
      if (effects == 2) add_pairs(tries);
      const Fitted before = found_.best;
      found_.best = best_accepted(fits_of(tries), before);
      if (found_.best.effects.size() < effects) return;
      std::vector<Fitted> fitted = fits_of(exchanges());
      fitted.push_back(found_.best);
      found_.best = best_accepted(fitted, before);
      while (found_.best.effects.size() > 1 && drop_one()) {
      }
      if (found_.best.effects.size() < effects) return;
    }
  }

  /// Leaves out what the others have made superfluous. @return whether there was one
  bool drop_one() {
    std::vector<Effects> tries;
    for (std::size_t i = 0; i < found_.best.effects.size(); ++i) {
      tries.push_back(found_.best.effects);
      tries.back().erase(tries.back().begin() + static_cast<std::ptrdiff_t>(i));
    }
    const Fitted* dropped = nullptr;
    const std::vector<Fitted> fitted = fits_of(tries);
    for (const Fitted& fewer : fitted)
      if (!accepted(found_.best, fewer, found_.base, request_.seed) &&
          (dropped == nullptr || less(fewer, *dropped)))
        dropped = &fewer;
    if (dropped == nullptr) return false;
    found_.best = *dropped;
    return true;
  }

  /// One of the best effects in another one's place: what was best alone need not be best beside the others.
  [[nodiscard]] std::vector<Effects> exchanges() const {
    std::vector<const Fitted*> singles;
    for (const Fitted& single : found_.singles) singles.push_back(&single);
    std::sort(singles.begin(), singles.end(), [](const Fitted* a, const Fitted* b) { return less(*a, *b); });
    std::vector<Effects> all;
    for (std::size_t i = 0; i < found_.best.effects.size(); ++i) {
      std::size_t exchanged = 0;
      for (const Fitted* single : singles) {
        const Candidate& other = *single->effects[0].candidate;
        const Candidate& replaced = *found_.best.effects[i].candidate;
        if (has(found_.best.effects, &other) || other.drive != replaced.drive || other.load != replaced.load)
          continue;
        if (++exchanged > kExchanged) break;
        all.push_back(found_.best.effects);
        all.back()[i] = single->effects[0];
      }
    }
    std::erase_if(all, [&](const Effects& tried) {
      return std::any_of(found_.all.begin(), found_.all.end(),
                         [&](const Fitted& known) { return same(known.effects, tried); });
    });
    return all;
  }

  void add_pairs(std::vector<Effects>& tries) const {
    std::vector<Effect> helpful;
    for (const Fitted& single : found_.singles)
      if (single.train.loss < found_.base.train.loss && helpful.size() < kPaired)
        helpful.push_back(single.effects[0]);
    for (std::size_t i = 0; i < helpful.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Effects pair{helpful[i], helpful[j]};
        if (std::none_of(tries.begin(), tries.end(), [&](const Effects& known) { return same(known, pair); }))
          tries.push_back(pair);
      }
  }

  /// Fits that cannot come near the best of those before are given up.
  std::vector<Fitted> fits_of(const std::vector<Effects>& tries) {
    std::vector<Fitted> fitted;
    double least = found_.best.train.loss;
    for (const Effects& effects : tries) {
      fitted.push_back(study_.fit(with_fresh_wave(effects), least + kHopeless, near(effects)));
      least = std::min(least, fitted.back().train.loss);
      rank(fitted.back(), 1);
      found_.all.push_back(fitted.back());
    }
    return fitted;
  }

  const Study& study_;
  const Request& request_;
  Hypotheses found_;
};

}  // namespace

Hypotheses singles(const Study& study, const Request& request) { return Search(study, request).singles(); }

Hypotheses singles_again(const Study& study, const Request& request, const Hypotheses& before) {
  return Search(study, request).singles_again(before);
}

Hypotheses extended(const Study& study, const Request& request, const Hypotheses& singles) {
  return Search(study, request).extended(singles);
}

}  // namespace crane::diagnosis
