#pragma once
/// A diagnosis against the opened answer.
#include <ostream>
#include <string>
#include <vector>

#include "sealed_case.hpp"

namespace crane::diagnosis::score {

enum class Judged {
  right,       ///< what is there is named and nothing else; nothing: "none"; outside the library: "unknown"
  among,       ///< ambiguous, what is there among the suspects
  group,       ///< named is, for some or all of what is there, another cause of the same confounded group
               ///< (docs/diagnosis.md, Limits)
  beside,      ///< named together with a cause that is not there
  partly,      ///< some of several causes named, or one that is alike
  unsure,      ///< "unknown" where a cause of the library is there
  missed,      ///< "none" where something is wrong
  wrong,       ///< a cause named that is not there, with confidence
  wrong_among  ///< ambiguous, what is there not among the suspects
};
[[nodiscard]] const char* name_of(Judged judged);
/// For messages of tests.
inline void PrintTo(Judged judged, std::ostream* out) { *out << name_of(judged); }

[[nodiscard]] Judged judge(const Diagnosis& found, const std::vector<HiddenEffect>& answer);

/// Whether two causes are alike until something else changes.
[[nodiscard]] bool confounded(const std::string& a, const std::string& b);

/// One estimated parameter of a cause that is there, against the truth's.
struct Compared {
  std::string cause, parameter;
  double truth = 0, estimate = 0, std_dev = 0;

  [[nodiscard]] bool inside() const;  ///< of the 95 % interval
  [[nodiscard]] bool within_5pc() const;
};
/// Parameters of the causes found that the truth's form shares with the library's.
[[nodiscard]] std::vector<Compared> compared(const Diagnosis& found, const std::vector<HiddenEffect>& answer);

}  // namespace crane::diagnosis::score
