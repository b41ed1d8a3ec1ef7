#pragma once
/// Which hypotheses a search fits: those that may become the best one.
#include <vector>

#include "study/hypothesis.hpp"
#include "study/score.hpp"

namespace crane::diagnosis {

/// Difference of the deviances, at least 0.
[[nodiscard]] double distance_from(const Fitted& best, const Fitted& fitted);

/// Largest decrease of the deviance to expect when the effect of a score is added to `given`. The score
/// predicts the share of the loss L that the effect removes. The noise model of `given` describes a part of
/// the effect as a disturbance: the true share s is at most predicted share / kLeastPredicted. A refit with
/// its own noise decreases the deviance by at most -L ln(1 - s).
/// @return infinite if s >= 1, if the loss of the cause is rough, or if the cause adds a natural frequency
[[nodiscard]] double reachable_decrease(const Score& score, const Candidate& candidate, const Fitted& given);

/// The first fits that a search refits with their own noise: those with the largest likelihood, and of the
/// others those with the largest reduction of an error. With fine sensors, the likelihood prefers small
/// errors of the times to the cause of a large error. A hypothesis that is larger than `best` must have a
/// larger likelihood.
[[nodiscard]] std::vector<Fitted> worth_a_refit(std::vector<Fitted> first_fits, const Fitted& base,
                                                const Fitted& best);

}  // namespace crane::diagnosis
