#pragma once
/// Which hypotheses are fitted.
#include <cstdint>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// Everything that was fitted.
struct Hypotheses {
  Fitted base, best;  ///< best: without effects when none was accepted or likely
  /// The best was accepted; otherwise it is likely, and the held-out data are too few to prove it.
  bool proven = true;
  std::vector<Fitted> singles, all;
  std::vector<Ranked> ranking;
  double detection_p_value = 1;
  std::vector<Visibility> excitation;  ///< in the noise that was learnt last
};

/// Scores of all candidates and fits of the best.
[[nodiscard]] Hypotheses singles(const Study& study, const Request& request);

/// Those of `before` once more, after the disturbance was learnt anew, and beside them what scores well now.
[[nodiscard]] Hypotheses singles_again(const Study& study, const Request& request, const Hypotheses& before);

/// Pairs of the singles, and one effect more as long as it helps.
[[nodiscard]] Hypotheses extended(const Study& study, const Request& request, const Hypotheses& singles);

}  // namespace crane::diagnosis
