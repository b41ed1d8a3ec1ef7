#include "study/design.hpp"

#include <algorithm>
#include <cmath>

#include "quantile.hpp"
#include "rules.hpp"
#include "study/blocks.hpp"
#include "study/score.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;

/// Amount, in standard deviations, that is found with the probability kPower if the largest of `tests` scores
/// without an effect exceeds the threshold with the probability rules::kSignificant (Bonferroni).
double found_at(std::size_t tests, bool one_sided) {
  const double sides = one_sided ? 1 : 2;
  return upper_quantile(rules::kSignificant / (sides * static_cast<double>(tests))) +
         upper_quantile(1 - kPower);
}

/// Standard deviation of a single amount: by the learnt noise, at least the scatter of the blocks.
double deviation(const BlockScores& at, Index i) {
  const double information = at.curvature(i, i);
  if (!(information > 0)) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::max(1 / information, at.by_block.col(i).squaredNorm() / (information * information)));
}

std::string label_of(const Candidate& candidate, const Score& place, std::size_t probe) {
  if (place.shape.probes.size() < 2) return candidate.label();
  for (const auto& [name, value] : place.shape.probes[probe].parameters) {
    const auto& parameters = candidate.parameters;
    const auto found =
        std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
    if (found != parameters.end() && value != found->null) return candidate.label() + " " + name;
  }
  return candidate.label();
}

/// Values of a candidate with `amount` along a probe. A candidate without small amounts: the first value is
/// scaled.
std::vector<double> values_of(const Candidate& candidate, const Score& place, std::size_t probe,
                              double amount) {
  const Shape& shape = place.shape;
  if (shape.large_probe) {
    std::vector<double> values = candidate.begin(shape, shape.amounts);
    values[0] = candidate.parameters[0].null + (values[0] - candidate.parameters[0].null) * amount;
    return values;
  }
  std::vector<double> amounts(shape.amounts.size(), 0.0);
  amounts[probe] = amount;
  return candidate.begin(shape, amounts);
}

bool beyond_bounds(const Candidate& candidate, const Score& place, std::size_t probe, double amount) {
  if (!std::isfinite(amount)) return true;
  const std::vector<double> values = values_of(candidate, place, probe, amount);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const FreeParameter& p = candidate.parameters[i];
    if (values[i] != p.null && (values[i] <= p.low || values[i] >= p.high) && i == 0) return true;
  }
  return false;
}

void add_alike(const std::vector<std::size_t>& of, const BlockScores& at, std::vector<Visibility>& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j) {
      const auto a = static_cast<Index>(i), b = static_cast<Index>(j);
      const double size = std::sqrt(at.curvature(a, a) * at.curvature(b, b));
      if (of[i] == of[j] || !(size > 0)) continue;
      const double cosine = at.curvature(a, b) / size;
      if (std::abs(cosine) >= kAlike) all[i].alike.push_back({all[j].label, cosine});
    }
    std::sort(all[i].alike.begin(), all[i].alike.end(),
              [](const auto& x, const auto& y) { return std::abs(x.cosine) > std::abs(y.cosine); });
  }
}

}  // namespace

std::vector<Direction> strongest_directions(const std::vector<Score>& places,
                                            const std::vector<std::vector<double>>& information) {
  std::vector<Direction> directions;
  for (std::size_t first = 0; first < places.size();) {
    std::size_t end = first, best = first;
    double most = -1;
    for (; end < places.size() && places[end].candidate == places[first].candidate; ++end) {
      // Prefers the shape with small amounts; otherwise the setting with the largest information.
      const double least = *std::min_element(information[end].begin(), information[end].end());
      const double worth = places[end].shape.large_probe ? least / (1 + least) - 1 : least;
      if (worth > most) most = worth, best = end;
    }
    for (std::size_t probe = 0; probe < places[best].shape.probes.size(); ++probe)
      directions.push_back({best, probe});
    first = end;
  }
  return directions;
}

std::vector<Visibility> visibility_of(const std::vector<Candidate>& candidates,
                                      const std::vector<Score>& places,
                                      const std::vector<Direction>& directions, const BlockScores& at) {
  std::vector<Visibility> all;
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Score& place = places[directions[i].place];
    const Candidate& candidate = candidates[place.candidate];
    const std::size_t probe = directions[i].probe;
    const bool one_sided = candidate.one_sided || place.shape.large_probe;
    const double least = found_at(directions.size(), one_sided) * deviation(at, static_cast<Index>(i));
    Visibility visibility;
    visibility.label = label_of(candidate, place, probe);
    visibility.cause = candidate.cause, visibility.axis = candidate.axis;
    visibility.visible = !beyond_bounds(candidate, place, probe, least);
    if (std::isfinite(least)) {
      const std::vector<double> values = values_of(candidate, place, probe, least);
      for (std::size_t k = 0; k < values.size(); ++k)
        visibility.least.push_back(
            {candidate.parameters[k].name, candidate.parameters[k].unit, values[k], 0});
    }
    all.push_back(std::move(visibility));
    of.push_back(place.candidate);
  }
  add_alike(of, at, all);
  return all;
}

}  // namespace crane::diagnosis
