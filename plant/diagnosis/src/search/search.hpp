#pragma once
/// Search over hypotheses. Each hypothesis is judged by the likelihood of the training data with the noise
/// model of its own residual. The noise model of the base model describes the missing effect as a
/// disturbance, and can hardly distinguish two hypotheses.
#include <cstdint>
#include <vector>

#include "crane/diagnosis/diagnosis.hpp"
#include "study/own_noise.hpp"

namespace crane::diagnosis {

/// Everything that was fitted.
struct Hypotheses {
  Fitted base, best;        ///< best: without effects when none was accepted
  std::vector<Fitted> all;  ///< without the base
  std::vector<Ranked> ranking;
  double detection_p_value = 1;
  std::vector<Visibility> excitation;
};

/// Forward search from the base model: at every size the likeliest hypotheses are extended by their strongest
/// candidates (beam search).
/// @return the base model is evaluated in the noise of the best hypothesis
[[nodiscard]] Hypotheses searched(const Study& study, const BaseModel& base, const Request& request);

}  // namespace crane::diagnosis
