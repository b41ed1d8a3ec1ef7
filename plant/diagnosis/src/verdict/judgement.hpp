#pragma once
/// The verdict over what was fitted.
#include "data/lost_counts.hpp"
#include "search/search.hpp"

namespace crane::diagnosis {

/// Verdict, causes without their values, what is left, sentence.
struct Judged {
  Diagnosis diagnosis;
  Effects rival;  ///< of all hypotheses the one that would most often take the best one's place; only when
                  ///< ambiguous
};
/// The verdict in words.
[[nodiscard]] std::string said(const Diagnosis& diagnosis);

/// Makes the verdict "unknown".
/// @param why what the remainder goes with
void doubt(Diagnosis& diagnosis, const std::string& why);

/// @param losing encoders whose jumps were put back: residuals that go with them are explained
[[nodiscard]] Judged judge(const Study& study, const Hypotheses& hypotheses,
                           const std::vector<LosingEncoder>& losing, std::uint64_t seed);

}  // namespace crane::diagnosis
