#pragma once
/// Comparing hypotheses inside the training data.
#include <cstdint>

#include "fit/ascent.hpp"

namespace crane::innovations {

/// log likelihood of every value at the estimate that leaves its fold out: whole runs where there are at
/// least rule::kLeastRuns, interleaved blocks otherwise. The estimate of a fold is one Newton step from the
/// common one, theta - (I - I_f)^-1 g_f (Stone 1974; the infinitesimal jackknife).
[[nodiscard]] std::vector<double> cross_validated(const Problem& problem, const Fit& fit,
                                                  const std::vector<Index>& free);

/// Quantile of the sum of resampled blocks (Kuensch 1989). No block counts for more than 2.5 times what nine
/// tenths of them keep to.
[[nodiscard]] double resampled_sum(const std::vector<double>& by_block, double level, std::uint64_t seed);
/// Share of resamples with a positive sum.
[[nodiscard]] double share_positive(const std::vector<double>& by_block, std::uint64_t seed);

[[nodiscard]] std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace crane::innovations
