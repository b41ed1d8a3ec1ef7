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
/// What improves the training loss by a smaller share is of no consequence for the crane.
constexpr double kLeastShare = 0.01;
constexpr std::size_t kRefitted = 8;
constexpr std::size_t kPaired = 5;
constexpr std::size_t kExtensions = 4;
constexpr int kVotes = 500;
/// Flipping the signs of fewer blocks proves nothing about what is left beside a fitted effect.
constexpr std::size_t kFewBlocks = 60;

bool same(const Effects& a, const Effects& b) {
  if (a.size() != b.size()) return false;
  return std::all_of(a.begin(), a.end(), [&](const Effect& e) {
    return std::any_of(b.begin(), b.end(), [&](const Effect& f) { return f.candidate == e.candidate; });
  });
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

std::vector<Score> strongest(const ScoreTable& scores, std::size_t count) {
  std::vector<Score> order = scores.best;
  std::sort(order.begin(), order.end(), [](const Score& a, const Score& b) { return a.gain > b.gain; });
  order.resize(std::min(count, order.size()));
  return order;
}

class Search {
 public:
  Search(const Study& study, const Request& request) : study_(study), request_(request) {
    found_.base.train = study.base_train();
    found_.base.test = study.base_test();
  }

  Hypotheses run() {
    request_.progress(0.1, "scores of all candidates");
    const ScoreTable scores = study_.score({}, found_.base.train, request_.seed);
    found_.detection_p_value = scores.p_value;
    fit_singles(scores);
    choose();
    return std::move(found_);
  }

  /// Once more from where the singles are, with another idea of the disturbance.
  Hypotheses run_again(const Hypotheses& before) {
    found_.detection_p_value = before.detection_p_value;
    for (const Fitted& single : before.singles) {
      found_.singles.push_back(study_.fit(single.effects));
      const auto at = static_cast<std::size_t>(&single - before.singles.data());
      rank(found_.singles.back(), before.ranking[at].p_value);
    }
    choose();
    return std::move(found_);
  }

 private:
  void choose() {
    found_.all = found_.singles;
    const auto best = std::min_element(found_.singles.begin(), found_.singles.end(), less);
    if (best == found_.singles.end() || !accepted(*best, found_.base, request_.seed)) {
      found_.best = found_.base;
    } else {
      found_.best = *best;
      extend();
    }
  }

  /// `score`'s candidate as its score says, beside what is there already. A nonlinear one begins in the shape
  /// that does best as it is.
  [[nodiscard]] Effects begin(const Effects& there, const Score& score) const {
    const Candidate& candidate = study_.candidates()[score.candidate];
    Effects best = there;
    best.push_back({&candidate, candidate.begin(candidate.shapes[score.shape], score.amounts)});
    if (!candidate.nonlinear) return best;
    double least = INFINITY;
    for (const Shape& shape : candidate.shapes) {
      Effects tried = there;
      tried.push_back({&candidate, candidate.begin(shape, {})});
      const double loss = study_.train(tried).loss;
      if (loss < least) least = loss, best = std::move(tried);
    }
    return best;
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
      Fitted better = best_of(tries);
      if (!accepted(better, found_.best, request_.seed)) return;
      found_.best = std::move(better);
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

  Fitted best_of(const std::vector<Effects>& tries) {
    std::vector<Fitted> fitted;
    for (const Effects& effects : tries) {
      fitted.push_back(study_.fit(effects));
      rank(fitted.back(), 1);
      found_.all.push_back(fitted.back());
    }
    return *std::min_element(fitted.begin(), fitted.end(), less);
  }

  const Study& study_;
  const Request& request_;
  Hypotheses found_;
};

}  // namespace

Hypotheses search(const Study& study, const Request& request) { return Search(study, request).run(); }

Hypotheses search_again(const Study& study, const Request& request, const Hypotheses& before) {
  return Search(study, request).run_again(before);
}

bool accepted(const Fitted& fitted, const Fitted& before, std::uint64_t seed) {
  if (before.train.loss - fitted.train.loss < kLeastShare * before.train.loss) return false;
  const Wins wins = block_wins(fitted, before, seed);
  return wins.all > 1 - kSignificant && wins.held_out > kHeldOutWin;
}

std::vector<double> frequencies(const std::vector<const Fitted*>& rivals, std::uint64_t seed) {
  std::vector<double> picked(rivals.size(), 0.0);
  std::mt19937_64 random(seed + 17);
  const std::size_t train = rivals[0]->train.blocks.size(), count = blocks(*rivals[0]);
  for (int i = 0; i < kVotes; ++i) {
    std::vector<double> total(rivals.size());
    for (std::size_t r = 0; r < rivals.size(); ++r)
      total[r] = price(*rivals[r]) * static_cast<double>(rivals[r]->parameters);
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
