#pragma once
/// Selection of the candidates that are fitted.
#include <cstddef>
#include <vector>

#include "study/score.hpp"

namespace crane::diagnosis {

/// Candidates whose effect on the data resembles that of `candidate` (design.hpp).
[[nodiscard]] std::vector<const Candidate*> alike(const Candidate& candidate,
                                                  const std::vector<Candidate>& candidates,
                                                  const std::vector<Visibility>& excitation);

/// First the candidates in `always`, then the strongest: half of them by predicted share of the loss, half by
/// p value. The score of a large effect scatters from block to block, which raises its p value; in a rough
/// residual the predicted share is large by chance.
/// @param count number of the strongest
[[nodiscard]] std::vector<Score> strongest(std::vector<Score> left, std::size_t count,
                                           std::vector<Score> always);

}  // namespace crane::diagnosis
