#pragma once
/// The verdict over what was fitted.
#include "search.hpp"

namespace crane::diagnosis {

/// Verdict, causes, rivals, what is left, sentence; not the next experiment.
struct Judged {
  Diagnosis diagnosis;
  std::vector<const Candidate*> rivals;  ///< strongest first; only when ambiguous
};
/// @param held_out of the best hypothesis, for the report
[[nodiscard]] Judged judge(const Study& study, const Hypotheses& hypotheses, const HeldOut& held_out,
                           std::uint64_t seed);

}  // namespace crane::diagnosis
