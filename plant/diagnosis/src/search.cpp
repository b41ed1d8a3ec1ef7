#include "search.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace crane::diagnosis {
namespace {

/// A score this unlikely by luck is something.
constexpr double kSignificant = 0.01;
/// Held-out data are fewer: they have to agree, not to prove it alone.
constexpr double kHeldOutWin = 0.9;
/// What improves the training loss of neither drives nor load by such a share is of no consequence for the
/// crane.
constexpr double kLeastShare = 0.03;
constexpr std::size_t kRefitted = 8;
constexpr std::size_t kPaired = 5;
constexpr std::size_t kExtensions = 6;
/// A rival whose training loss will stay this much above the best one's does not win a resample.
constexpr double kHopeless = 30;
constexpr int kVotes = 500;
/// Flipping the signs of fewer blocks proves nothing about what is left beside a fitted effect.
constexpr std::size_t kFewBlocks = 60;

bool has(const Effects& effects, const Candidate* candidate) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const Effect& e) { return e.candidate == candidate; });
}

std::size_t blocks(const Fitted& f) { return f.train.blocks.size() + f.test.blocks.size(); }

/// Of one parameter, in units of one noise variance: that of the Bayesian information criterion.
double price(const Fitted& f) { return std::log(static_cast<double>(blocks(f))); }

/// What a hypothesis is judged by: training and held-out loss together with a price for its parameters.
double value(const Fitted& f) {
  return f.train.loss + f.test.loss + price(f) * static_cast<double>(f.parameters);
}

bool less(const Fitted& a, const Fitted& b) { return value(a) < value(b); }

/// Shares of resamples of all blocks in which `f` is better than `before`: in all, in the held-out ones.
struct Wins {
  double all = 0, held_out = 0;
};

Wins block_wins(const Fitted& f, const Fitted& before, std::uint64_t seed) {
  std::vector<double> difference;
  for (std::size_t i = 0; i < f.train.blocks.size(); ++i)
    difference.push_back(before.train.blocks[i] - f.train.blocks[i]);
  const std::size_t training = difference.size();
  for (std::size_t i = 0; i < f.test.blocks.size(); ++i)
    difference.push_back(before.test.blocks[i] - f.test.blocks[i]);
  const double extra =
      price(f) * (static_cast<double>(f.parameters) - static_cast<double>(before.parameters));
  std::mt19937_64 random(seed);
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
    fit_singles(scores);
    choose();
    return std::move(found_);
  }

  Hypotheses singles_again(const Hypotheses& before) {
    found_.detection_p_value = before.detection_p_value;
    const double least = study_.fit(before.likeliest.effects).train.loss;
    for (std::size_t i = 0; i < before.singles.size(); ++i) {
      found_.singles.push_back(study_.fit(before.singles[i].effects, least + kHopeless));
      rank(found_.singles.back(), before.ranking[i].p_value);
    }
    choose();
    return std::move(found_);
  }

  Hypotheses extended(const Hypotheses& singles) {
    found_ = singles;
    if (!found_.best.effects.empty()) extend();
    if (!found_.best.effects.empty()) found_.likeliest = found_.best;
    return std::move(found_);
  }

 private:
  void choose() {
    found_.all = found_.singles;
    found_.best = found_.likeliest = best_accepted(found_.singles, found_.base);
    if (found_.best.effects.empty() && !found_.singles.empty())
      found_.likeliest = *std::min_element(found_.singles.begin(), found_.singles.end(), less);
  }

  /// `before` when none is accepted in its place.
  [[nodiscard]] Fitted best_accepted(const std::vector<Fitted>& fitted, const Fitted& before) const {
    const Fitted* best = nullptr;
    for (const Fitted& one : fitted)
      if ((best == nullptr || less(one, *best)) && accepted(one, before, request_.seed)) best = &one;
    return best == nullptr ? before : *best;
  }

  /// `score`'s candidate as its score says, beside what is there already.
  [[nodiscard]] Effects begin(const Effects& there, const Score& score) const {
    const Candidate& candidate = study_.candidates()[score.candidate];
    Effects all = there;
    all.push_back({&candidate, candidate.begin(candidate.shapes[score.shape], score.amounts)});
    return all;
  }

  void fit_singles(const ScoreTable& scores) {
    const std::vector<Score> order = strongest(scores, kRefitted);
    for (std::size_t i = 0; i < order.size(); ++i) {
      request_.progress(0.15 + 0.3 * static_cast<double>(i) / kRefitted,
                        "fit of " + study_.candidates()[order[i].candidate].label());
      found_.singles.push_back(study_.fit(begin({}, order[i])));
      rank(found_.singles.back(), order[i].p_value);
    }
  }

  void rank(const Fitted& f, double p_value) {
    Ranked ranked;
    for (const Effect& effect : f.effects)
      ranked.label += (ranked.label.empty() ? "" : " + ") + effect.candidate->label();
    ranked.parameters = estimates(f);
    ranked.train_gain = found_.base.train.loss - f.train.loss;
    ranked.test_gain = found_.base.test.loss - f.test.loss;
    ranked.p_value = p_value;
    found_.ranking.push_back(ranked);
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
      const std::vector<Fitted> fitted = fits_of(tries);
      found_.best = best_accepted(fitted, found_.best);
      if (found_.best.effects.size() < effects) return;
    }
  }

  void add_pairs(std::vector<Effects>& tries) const {
    for (std::size_t i = 0; i < std::min(kPaired, found_.singles.size()); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Effects pair{found_.singles[i].effects[0], found_.singles[j].effects[0]};
        if (std::none_of(tries.begin(), tries.end(), [&](const Effects& known) { return same(known, pair); }))
          tries.push_back(pair);
      }
  }

  /// Fits that cannot come near the best of those before are given up.
  std::vector<Fitted> fits_of(const std::vector<Effects>& tries) {
    std::vector<Fitted> fitted;
    double least = found_.best.train.loss;
    for (const Effects& effects : tries) {
      fitted.push_back(study_.fit(effects, least + kHopeless));
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

bool same(const Effects& a, const Effects& b) {
  return a.size() == b.size() &&
         std::all_of(a.begin(), a.end(), [&](const Effect& e) { return has(b, e.candidate); });
}

bool accepted(const Fitted& fitted, const Fitted& before, std::uint64_t seed) {
  const Evaluation &old = before.train, &now = fitted.train;
  if (now.loss >= old.loss || (old.drive_loss - now.drive_loss < kLeastShare * old.drive_loss &&
                               old.load_loss - now.load_loss < kLeastShare * old.load_loss))
    return false;
  const Wins wins = block_wins(fitted, before, seed);
  return wins.all > 1 - kSignificant && wins.held_out > kHeldOutWin;
}

namespace {

/// Parts in which what `a` has and `b` has not shows.
struct ShowsIn {
  bool drive = false, load = false;
};
ShowsIn only_in(const Fitted& a, const Fitted& b) {
  ShowsIn parts;
  for (const Effect& e : a.effects) {
    const bool shared = has(b.effects, e.candidate);
    parts.drive = parts.drive || (!shared && e.candidate->drive);
    parts.load = parts.load || (!shared && e.candidate->load);
  }
  return parts;
}

/// What `rival` does better block by block in the parts where it would have to replace what only `best` has.
std::vector<double> advantage(const Fitted& rival, const Fitted& best) {
  const ShowsIn parts = only_in(best, rival);
  std::vector<double> margins;
  for (const auto& [of_best, of_rival] : {std::pair{&best.train, &rival.train}, {&best.test, &rival.test}})
    for (std::size_t i = 0; i < of_best->blocks.size(); ++i) {
      const bool counts = i < of_best->drive_blocks ? parts.drive : parts.load;
      margins.push_back(counts ? of_best->blocks[i] - of_rival->blocks[i] : 0);
    }
  return margins;
}

}  // namespace

std::vector<double> frequencies(const Fitted& best, const std::vector<const Fitted*>& rivals,
                                std::uint64_t seed) {
  std::vector<std::vector<double>> margins;
  for (const Fitted* rival : rivals) margins.push_back(advantage(*rival, best));
  std::vector<double> picked(rivals.size(), 0.0);
  std::mt19937_64 random(seed + 17);
  const std::size_t count = blocks(best);
  for (int i = 0; i < kVotes; ++i) {
    std::vector<double> total(rivals.size());
    for (std::size_t r = 0; r < rivals.size(); ++r)
      total[r] =
          price(best) * (static_cast<double>(best.parameters) - static_cast<double>(rivals[r]->parameters));
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = static_cast<std::size_t>(random() % count);
      for (std::size_t r = 0; r < rivals.size(); ++r) total[r] += margins[r][at];
    }
    const auto winner = std::max_element(total.begin(), total.end());
    if (winner != total.end() && *winner > 0)
      picked[static_cast<std::size_t>(winner - total.begin())] += 1.0 / kVotes;
  }
  return picked;
}

std::vector<Estimate> estimates(const Fitted& f) {
  std::vector<Estimate> all;
  std::size_t i = 0;
  for (const Effect& effect : f.effects)
    for (std::size_t k = 0; k < effect.values.size(); ++k, ++i)
      all.push_back({effect.candidate->parameters[k].name, effect.candidate->parameters[k].unit,
                     effect.values[k], f.std_dev[i]});
  return all;
}

}  // namespace crane::diagnosis
