#pragma once
/// Comparisons of fitted hypotheses by the deviances of the blocks of the data: a test of the mean
/// difference, and votes of block resamples.
#include <cstdint>
#include <vector>

#include "study/hypothesis.hpp"

namespace crane::diagnosis {

/// One-sided p value of the hypothesis "on average, `now` is not lower than `before`", from the scatter of
/// the differences of the blocks. Large differences are limited, so that no block dominates.
[[nodiscard]] double block_test_p_value(const Blocks& now, const Blocks& before);

/// Share of block resamples in which the sum of `now` is lower than the sum of `before`. Large differences
/// are limited as above.
[[nodiscard]] double block_wins(const Blocks& now, const Blocks& before, std::uint64_t seed);

/// Share of the votes for each rival; the remaining votes are for `best`. Each block resample is one vote. A
/// vote compares `best` with a rival in the parts of the data (drive, load) that show the effects that only
/// `best` has. The rival with the lowest deviance gets the whole vote when its deviance is lower than that of
/// `best` by more than kIndistinct times the gain of `best`. Otherwise `best` shares the vote equally with
/// all rivals whose deviance is not higher by more than this.
/// @param base the model without effects
[[nodiscard]] std::vector<double> shares_of_votes(const Fitted& best,
                                                  const std::vector<const Fitted*>& rivals,
                                                  const Fitted& base, std::uint64_t seed);

}  // namespace crane::diagnosis
