#include "search/block_votes.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "rules.hpp"
#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

constexpr int kVotes = static_cast<int>(rules::kVotes.count());

/// Limits each difference to twice the 95 % quantile of the magnitudes. Without the limit, one block can
/// outweigh all others: a slip that comes a little earlier or later changes its block as much as a real
/// effect changes all blocks together. A block with the difference 0 does not count: no effect is visible in
/// its part of the data.
void limit(std::vector<double>& differences) {
  std::vector<double> sizes;
  sizes.reserve(differences.size());
  for (const double difference : differences)
    if (difference != 0) sizes.push_back(std::abs(difference));
  if (sizes.empty()) return;
  const auto usual = sizes.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sizes.size()));
  std::nth_element(sizes.begin(), usual, sizes.end());
  for (double& difference : differences) difference = std::clamp(difference, -2 * *usual, 2 * *usual);
}

}  // namespace

double block_test_p_value(const Blocks& now, const Blocks& before) {
  std::vector<double> difference;
  for (std::size_t i = 0; i < now.size(); ++i) difference.push_back(before[i] - now[i]);
  limit(difference);
  double sum = 0, squares = 0;
  for (const double one : difference) sum += one, squares += one * one;
  if (!(sum > 0) || difference.size() < 2) return 1;
  const double count = static_cast<double>(difference.size()), variance = squares - sum * sum / count;
  return variance > 0 ? 0.5 * std::erfc(sum / std::sqrt(2 * variance * count / (count - 1))) : 0;
}

double block_wins(const Blocks& now, const Blocks& before, std::uint64_t seed) {
  std::vector<double> difference;
  for (std::size_t i = 0; i < now.size(); ++i) difference.push_back(before[i] - now[i]);
  limit(difference);
  std::mt19937_64 random(seed);
  double wins = 0;
  for (int i = 0; i < kVotes; ++i) {
    double all = 0;
    for (std::size_t k = 0; k < difference.size(); ++k)
      all += difference[static_cast<std::size_t>(random() % difference.size())];
    wins += all > 0 ? 1.0 / kVotes : 0;
  }
  return wins;
}

namespace {

/// Parts of the data in which the effects of `a` that `b` lacks are visible.
ShowsIn only_in(const Fitted& a, const Fitted& b) {
  ShowsIn parts;
  for (const Effect& e : a.effects) {
    const bool shared = has(b.effects, e.candidate);
    parts.drive = parts.drive || (!shared && e.candidate->drive);
    parts.load = parts.load || (!shared && e.candidate->load);
  }
  return parts;
}

/// Share of the fitted values that an effect does not need: amounts after its first that do not differ
/// significantly from their null value. The effect explains the data as well without them.
double superfluous_share(const Fitted& fitted) {
  std::size_t first = 0, superfluous = 0;
  for (const Effect& effect : fitted.effects) {
    for (std::size_t k = 1; k < effect.candidate->amount_count; ++k) {
      const double distance = std::abs(effect.values[k] - effect.candidate->parameters[k].null);
      const double p_value = std::erfc(distance / (fitted.block_std_dev[first + k] * std::numbers::sqrt2));
      superfluous += p_value > rules::kFamilywiseLevel ? 1 : 0;
    }
    first += effect.values.size();
  }
  return first > 0 ? static_cast<double>(superfluous) / static_cast<double>(first) : 0;
}

/// Deviance by block, without the penalty of the values that the effects do not need.
Blocks deviance_of_needed(const Fitted& fitted) {
  Blocks deviance = fitted.deviance;
  const double penalty = sum(fitted.left_out) > 0 ? fitted.penalty / sum(fitted.left_out) : 0;
  const double share = superfluous_share(fitted);
  for (std::size_t i = 0; i < fitted.left_out.size(); ++i)
    deviance[i] -= share * penalty * fitted.left_out[i];
  return deviance;
}

/// Decrease of the deviance by block in these parts of the data; 0 in the other parts.
std::vector<double> decrease(const Blocks& now, const Blocks& before, const ShowsIn& parts,
                             std::size_t drive_blocks) {
  std::vector<double> decreases;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool counts = i < drive_blocks ? parts.drive : parts.load;
    decreases.push_back(counts ? before[i] - now[i] : 0);
  }
  return decreases;
}

/// A rival of the best hypothesis in one vote.
struct Rival {
  std::vector<double> margins;  ///< decrease of the deviance by block; < 0: increase
  double indistinct = 0;        ///< difference of the deviances that distinguishes nothing
};

Rival rival_of(const Fitted& best, const Fitted& rival, const Fitted& base) {
  const ShowsIn parts = only_in(best, rival);
  const Blocks of_best = deviance_of_needed(best);
  Rival result{decrease(deviance_of_needed(rival), of_best, parts, best.train.drive_blocks), 0};
  limit(result.margins);
  const std::vector<double> gain = decrease(of_best, base.deviance, parts, best.train.drive_blocks);
  result.indistinct = rules::kIndistinct * std::max(0.0, sum(gain));
  return result;
}

}  // namespace

std::vector<double> shares_of_votes(const Fitted& best, const std::vector<const Fitted*>& rivals,
                                    const Fitted& base, std::uint64_t seed) {
  std::vector<Rival> all;
  all.reserve(rivals.size());
  for (const Fitted* rival : rivals) all.push_back(rival_of(best, *rival, base));
  std::vector<double> picked(rivals.size(), 0.0);
  std::mt19937_64 random(seed + 17);
  const std::size_t count = best.deviance.size();
  for (int i = 0; i < kVotes; ++i) {
    std::vector<double> total(rivals.size(), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t at = static_cast<std::size_t>(random() % count);
      for (std::size_t r = 0; r < rivals.size(); ++r) total[r] += all[r].margins[at];
    }
    const auto winner = std::max_element(total.begin(), total.end());
    if (winner == total.end()) continue;
    const auto first = static_cast<std::size_t>(winner - total.begin());
    if (*winner > all[first].indistinct) {
      picked[first] += 1.0 / kVotes;
      continue;
    }
    std::vector<std::size_t> equal;
    for (std::size_t r = 0; r < rivals.size(); ++r)
      if (total[r] > -all[r].indistinct) equal.push_back(r);
    for (const std::size_t r : equal) picked[r] += 1.0 / kVotes / static_cast<double>(equal.size() + 1);
  }
  return picked;
}

}  // namespace crane::diagnosis
