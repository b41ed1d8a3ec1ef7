#pragma once
/// When one fitted hypothesis is better than another.
#include <cstdint>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// A score this unlikely by luck is something.
inline constexpr double kSignificant = 0.01;

[[nodiscard]] bool has(const Effects& effects, const Candidate* candidate);

/// "command_delay (trolley) + payload_mass"
[[nodiscard]] std::string label_of(const Effects& effects);

/// By the likelihood of the training data, each block left out of the fit.
[[nodiscard]] bool less(const Fitted& a, const Fitted& b);

/// The same candidates, whatever their values.
[[nodiscard]] bool same(const Effects& a, const Effects& b);

/// Largest share of the error of `before` that `fitted` takes off a column, in windows or of a swing over
/// whole runs, of the columns that what only `fitted` has acts on.
[[nodiscard]] double share_of_error(const Fitted& fitted, const Fitted& before);

/// Likelier beyond resampling, and nearer to what was measured by a share of the error that matters.
[[nodiscard]] bool accepted(const Fitted& fitted, const Fitted& before, std::uint64_t seed);
/// Likelier than `base` beyond resampling.
[[nodiscard]] bool possible(const Fitted& fitted, const Fitted& base, std::uint64_t seed);

/// Share of resamples of the blocks in which `now` is less than `before`; no block outvotes the others.
[[nodiscard]] double block_wins(const Blocks& now, const Blocks& before, std::uint64_t seed);

/// How often, when the blocks are resampled, each of the rivals is likelier than `best` where it would have
/// to replace what only `best` has. The rest of the votes are for `best`.
[[nodiscard]] std::vector<double> frequencies(const Fitted& best, const std::vector<const Fitted*>& rivals,
                                              std::uint64_t seed);

[[nodiscard]] std::vector<Estimate> estimates(const Fitted& fitted);

}  // namespace crane::diagnosis
