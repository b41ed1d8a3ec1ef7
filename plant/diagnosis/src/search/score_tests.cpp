#include "search/score_tests.hpp"

#include <algorithm>

#include "search/compare.hpp"

namespace crane::diagnosis {

const ScoreTable& ScoreTests::beside(const WhitenedData& data, const Fitted& given) {
  const auto known = std::ranges::find_if(scored_, [&](const Scored& scored) {
    return same(scored.effects, given.effects) && scored.deviance == given.deviance;
  });
  if (known != scored_.end()) return known->table;
  const std::uint64_t seed = seed_ + given.effects.size();
  return scored_
      .emplace_back(given.effects, given.deviance,
                    score_test(data, given.effects, given.train, seed, probe_slopes_))
      .table;
}

}  // namespace crane::diagnosis
