#pragma once
/// Which hypotheses are fitted. Each is judged by the likelihood of the training data in the noise that it
/// leaves itself: in the noise that the base_model model leaves, which holds the effect as a disturbance,
/// hardly any hypothesis is told from another one.
#include <cstdint>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {

/// Everything that was fitted.
struct Hypotheses {
  Fitted base, best;        ///< best: without effects when none was accepted
  std::vector<Fitted> all;  ///< without the base
  std::vector<Ranked> ranking;
  double detection_p_value = 1;
  std::vector<Visibility> excitation;
};

/// Forward from the base model: at every size the likeliest hypotheses are extended by what scores best
/// beside them (beam search). From then on the study is whitened with the noise of the best one.
/// @pre study.learn_disturbance()
[[nodiscard]] Hypotheses searched(Study& study, const Request& request);

}  // namespace crane::diagnosis
