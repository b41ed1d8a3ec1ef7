#pragma once
/// Comparisons of fitted hypotheses.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "study/hypothesis.hpp"

namespace crane::diagnosis {

[[nodiscard]] bool has(const Effects& effects, const Candidate* candidate);

/// "command_delay (trolley) + payload_mass"
[[nodiscard]] std::string label_of(const Effects& effects);

/// Compares minus twice the log likelihood of the training data plus the penalty of the fitted values, and
/// rules::kRarerCause for each rarer cause.
[[nodiscard]] bool less(const Fitted& a, const Fitted& b);

/// Compares minus twice the log likelihood of the training data.
[[nodiscard]] bool likelier_without_penalty(const Fitted& a, const Fitted& b);

/// True if each effect of `rival` that `best` lacks has its more common cause (Candidate::rarer_than) in
/// `best`, on the same axis.
[[nodiscard]] bool differs_by_rarer_causes(const Effects& rival, const Effects& best);

/// True when both have the same candidates; their values may differ.
[[nodiscard]] bool same(const Effects& a, const Effects& b);

/// Largest relative reduction of the error of a column from `before` to `fitted`, in windows or, for a swing,
/// over whole runs. Only the columns on which an effect acts that `before` does not have.
[[nodiscard]] double share_of_error(const Fitted& fitted, const Fitted& before);

/// Like share_of_error(), in windows only.
[[nodiscard]] double share_of_error_in_windows(const Fitted& fitted, const Fitted& before);

/// True when three conditions hold:
/// - The increase of the likelihood is significant for the best of `candidates` (Bonferroni): block test and
///   likelihood-ratio test.
/// - The error decreases: for a first effect by more than kLeastAlone, for a further effect by any amount.
/// - Each further effect changes an output by at least kLeastBeside of the largest change of this output by
///   another effect. A smaller change could be the fit of a mismatch, because no term matches an effect
///   exactly.
[[nodiscard]] bool accepted(const Fitted& fitted, const Fitted& before, std::size_t candidates);
/// True when `fitted` is likelier than `base` in a significant share of block resamples.
[[nodiscard]] bool likelier_in_resamples(const Fitted& fitted, const Fitted& base, std::uint64_t seed);

/// p value of the likelihood-ratio test of "the additional values of `fitted` have no effect". Twice the log
/// likelihood ratio is chi-square distributed (Wilks, Ann. Math. Statist. 9 (1938) 60), for a composite
/// likelihood after division by the dispersion of its scores (Varin, Reid, Firth, Statist. Sinica 21 (2011)
/// 5, section 2.3). @param held_out_nats  gain of log likelihood of the held-out data, added to that of
/// training
[[nodiscard]] double likelihood_ratio_p_value(const Fitted& fitted, const Fitted& before,
                                              double held_out_nats = 0);
/// p value of a loss of held-out likelihood when the additional values of `fitted` have no effect. With as
/// many training as held-out data, the loss is half a chi-square with one degree of freedom for each value.
/// @param held_out_nats  gain of log likelihood of the held-out data; < 0: loss
[[nodiscard]] double held_out_loss_p_value(const Fitted& fitted, const Fitted& before, double held_out_nats);
/// p value of the Wald test (Trans. Amer. Math. Soc. 54 (1943) 426) of "the amount of the least certain
/// effect is 0": two-sided tail of the normal distribution at amount / standard deviation. For an effect with
/// two amounts, the more certain amount counts. In [0, 1]; 0 without effects.
/// @param fitted with interval_std_dev
[[nodiscard]] double wald_p_value(const Fitted& fitted);
/// True when `p_value` is not significant for the best of `candidates` (Bonferroni, kFamilywiseLevel).
[[nodiscard]] bool insignificant(double p_value, std::size_t candidates);

/// @param std_dev  Fitted::block_std_dev or interval_std_dev
[[nodiscard]] std::vector<Estimate> estimates(const Effects& effects, std::span<const double> std_dev);
/// Line of the ranking with block_std_dev, without p value and votes.
[[nodiscard]] Ranked ranked_against(const Fitted& base, const Fitted& fitted);

}  // namespace crane::diagnosis
