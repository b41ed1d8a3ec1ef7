#pragma once
/// Verdict on the fitted hypotheses.
#include "data/lost_counts.hpp"
#include "search/search.hpp"
#include "verdict/stated_accuracy.hpp"

namespace crane::diagnosis {

/// Verdict, causes without their values, remaining patterns, sentence.
struct Judged {
  Diagnosis diagnosis;
  Effects rival;  ///< the hypothesis with most votes after the best one; only when ambiguous
  std::vector<bool> within_accuracy;  ///< by effect of the best hypothesis; the others are causes
};
/// Makes the verdict "unknown".
/// @param why variable on which the remaining residual depends
void make_unknown(Diagnosis& diagnosis, const std::string& why);

/// @param best  hypotheses.best with the values and standard deviations of with_intervals()
/// @param losing encoders whose lost counts were restored: residuals that depend on them are explained
[[nodiscard]] Judged judge(const WhitenedData& data, const Hypotheses& hypotheses, const Fitted& best,
                           const StatedAccuracy& accuracy, const std::vector<LosingEncoder>& losing,
                           std::uint64_t seed);

}  // namespace crane::diagnosis
