#pragma once
/// Comparisons of fitted hypotheses block by block: test of the mean difference, and votes of block
/// resamples.
#include <cstdint>
#include <vector>

#include "study/study.hpp"

namespace crane::diagnosis {

/// p value of "the mean difference of the blocks is 0", one-sided (`now` < `before`), from the scatter of the
/// blocks. Large differences are clipped, so that no block dominates.
[[nodiscard]] double block_test_p_value(const Blocks& now, const Blocks& before);

/// Share of block resamples in which `now` < `before`. Large differences are clipped as above.
[[nodiscard]] double block_wins(const Blocks& now, const Blocks& before, std::uint64_t seed);

/// Share of the votes for each rival; the remaining votes are for `best`. Each block resample is one vote,
/// over the blocks on which those effects act that only `best` has. A rival whose deviance is lower than that
/// of `best` by more than kIndistinct of the gain of `best` gets the whole vote. Otherwise `best` shares the
/// vote equally with all rivals whose deviance is not higher by as much.
/// @param base the model without effects
[[nodiscard]] std::vector<double> frequencies(const Fitted& best, const std::vector<const Fitted*>& rivals,
                                              const Fitted& base, std::uint64_t seed);

}  // namespace crane::diagnosis
