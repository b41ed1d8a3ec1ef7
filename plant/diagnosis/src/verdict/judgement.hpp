#pragma once
/// The verdict over what was fitted.
#include "search/search.hpp"

namespace crane::diagnosis {

/// Verdict, causes without their values, rivals, what is left, sentence.
struct Judged {
  Diagnosis diagnosis;
  std::vector<const Candidate*> rivals;  ///< strongest first; only when ambiguous
};
/// Makes the verdict "unknown".
/// @param why what the remainder goes with
void doubt(Diagnosis& diagnosis, const std::string& why);

[[nodiscard]] Judged judge(const Study& study, const Hypotheses& hypotheses, std::uint64_t seed);

}  // namespace crane::diagnosis
