#pragma once
/// When one fitted hypothesis is better than another.
#include <cstdint>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

[[nodiscard]] bool has(const Effects& effects, const Candidate* candidate);

/// "command_delay (trolley) + payload_mass"
[[nodiscard]] std::string label_of(const Effects& effects);

/// By the likelihood of the training data with the price of the values.
[[nodiscard]] bool less(const Fitted& a, const Fitted& b);

/// The same candidates, whatever their values.
[[nodiscard]] bool same(const Effects& a, const Effects& b);

/// Largest share of the error of `before` that `fitted` takes off a column, in windows or of a swing over
/// whole runs, of the columns that what only `fitted` has acts on.
[[nodiscard]] double share_of_error(const Fitted& fitted, const Fitted& before);

/// Likelier beyond the luck of the best of so many candidates (Bonferroni), and nearer to what was measured
/// by a share of the error that matters.
[[nodiscard]] bool accepted(const Fitted& fitted, const Fitted& before, std::size_t candidates);
/// Likelier than `base` beyond resampling.
[[nodiscard]] bool possible(const Fitted& fitted, const Fitted& base, std::uint64_t seed);

/// Chance that `now` is less than `before` by nothing but luck: of the mean difference of the blocks, by
/// their scatter. No block outvotes the others.
[[nodiscard]] double luck_of(const Blocks& now, const Blocks& before);

/// Chance that as many more values as `fitted` has make the data likelier by as much: the likelihood ratio is
/// chi-square distributed (Wilks, Ann. Math. Statist. 9 (1938) 60), that of a composite likelihood after
/// division by the dispersion of its scores (Varin, Reid, Firth, Statist. Sinica 21 (2011) 5, section 2.3).
/// @param held_out_nats by which `fitted` makes held-out data likelier, that count as well
[[nodiscard]] double luck_of_values(const Fitted& fitted, const Fitted& before, double held_out_nats = 0);
/// Chance that as many more values as `fitted` has, where none of them is needed, make held-out data
/// unlikelier by as much: values that are known from as many data as they are tried on cost half a chi-square
/// of them.
/// @param held_out_nats by which `fitted` makes held-out data likelier
[[nodiscard]] double luck_of_loss(const Fitted& fitted, const Fitted& before, double held_out_nats);
/// Chance that the amount of the least certain effect is none (A. Wald, Trans. Amer. Math. Soc. 54 (1943)
/// 426): two-sided tail of the normal distribution at the amount, in standard deviations of its interval. Of
/// two amounts the more certain one counts. 0 to 1; 0 without effects.
/// @param fitted with std_dev from with_intervals()
[[nodiscard]] double luck_of_interval(const Fitted& fitted);
/// Whether a chance is luck where the best of so many candidates has it (Bonferroni).
[[nodiscard]] bool is_luck(double chance, std::size_t candidates);

/// Share of resamples of the blocks in which `now` is less than `before`; no block outvotes the others.
[[nodiscard]] double block_wins(const Blocks& now, const Blocks& before, std::uint64_t seed);

/// How often, when the blocks are resampled, each of the rivals is likelier than `best` where it would have
/// to replace what only `best` has. The rest of the votes are for `best`.
[[nodiscard]] std::vector<double> frequencies(const Fitted& best, const std::vector<const Fitted*>& rivals,
                                              std::uint64_t seed);

[[nodiscard]] std::vector<Estimate> estimates(const Fitted& fitted);

}  // namespace crane::diagnosis
