#pragma once
/// The verdict over what was fitted.
#include "search.hpp"

namespace crane::diagnosis {

/// Mean square of what the best hypothesis leaves, in those that noise and a coloured force can have made;
/// more than 1 is doubtful. Tells something as long as the disturbance was learnt from the bare model.
[[nodiscard]] double excess(const Fitted& best);

/// Verdict, causes, rivals, what is left, sentence; not the next experiment.
struct Judged {
  Diagnosis diagnosis;
  std::vector<const Candidate*> rivals;  ///< strongest first; only when ambiguous
};
/// @param held_out of the best hypothesis: a gain that is not proven is doubted
[[nodiscard]] Judged judge(const Study& study, const Hypotheses& hypotheses, const HeldOut& held_out,
                           std::uint64_t seed);

}  // namespace crane::diagnosis
