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
  std::vector<Fitted> singles, all;
  std::vector<Ranked> ranking;
  double detection_p_value = 1;
};

/// Scores of all candidates, fits of the best, pairs of them, one more as long as it helps.
[[nodiscard]] Hypotheses search(const Study& study, const Request& request);

/// The same, beginning with the singles of `before`, after the disturbance was learnt anew.
[[nodiscard]] Hypotheses search_again(const Study& study, const Request& request, const Hypotheses& before);

/// Better in training by a share of what was left that matters, and out of sample beyond doubt.
[[nodiscard]] bool accepted(const Fitted& fitted, const Fitted& before, std::uint64_t seed);

/// How often resampling the blocks picks each of the rivals. @pre not empty
[[nodiscard]] std::vector<double> frequencies(const std::vector<const Fitted*>& rivals, std::uint64_t seed);

[[nodiscard]] std::vector<Estimate> estimates(const Fitted& fitted);

}  // namespace crane::diagnosis
