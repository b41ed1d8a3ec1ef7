#pragma once
/// Which hypotheses are fitted, and when one is better than another.
#include <cstdint>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "study.hpp"

namespace crane::diagnosis {

/// Everything that was fitted.
struct Hypotheses {
  Fitted base, best;  ///< best: without effects when none was accepted
  Fitted likeliest;   ///< best, or the best single even when it was not accepted
  std::vector<Fitted> singles, all;
  std::vector<Ranked> ranking;
  double detection_p_value = 1;
};

/// Scores of all candidates and fits of the best.
[[nodiscard]] Hypotheses singles(const Study& study, const Request& request);

/// Those of `before` once more, after the disturbance was learnt anew.
[[nodiscard]] Hypotheses singles_again(const Study& study, const Request& request, const Hypotheses& before);

/// Pairs of the singles, and one effect more as long as it helps.
[[nodiscard]] Hypotheses extended(const Study& study, const Request& request, const Hypotheses& singles);

/// The same candidates, whatever their values.
[[nodiscard]] bool same(const Effects& a, const Effects& b);

/// Better in training by a share of what was left that matters, and out of sample beyond doubt.
[[nodiscard]] bool accepted(const Fitted& fitted, const Fitted& before, std::uint64_t seed);

/// How often, when the blocks are resampled, each of the rivals does better than `best` where it would have
/// to replace what only `best` has; the rest of the votes are for `best`.
[[nodiscard]] std::vector<double> frequencies(const Fitted& best, const std::vector<const Fitted*>& rivals,
                                              std::uint64_t seed);

[[nodiscard]] std::vector<Estimate> estimates(const Fitted& fitted);

}  // namespace crane::diagnosis
