#pragma once
/// Comparison of a diagnosis with the answer.
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "score/sealed_case.hpp"

namespace crane::diagnosis::score {

enum class Judged {
  right,       ///< exactly the hidden causes; "none" without any; "unknown" outside the library
  among,       ///< ambiguous, and the hidden cause is one of the rivals
  group,       ///< another cause of the same confounded group
  beside,      ///< the hidden cause and another cause
  partly,      ///< some of several hidden causes, or confounded causes
  unsure,      ///< "unknown" for a cause of the library
  missed,      ///< "none" for a hidden cause
  wrong,       ///< another cause is named
  wrong_among  ///< ambiguous, and the hidden cause is not one of the rivals
};
[[nodiscard]] const char* name_of(Judged judged);
/// Text for messages of tests.
inline void PrintTo(Judged judged, std::ostream* out) { *out << name_of(judged); }

[[nodiscard]] Judged judge(const Diagnosis& found, const std::vector<HiddenEffect>& answer);

/// Group of causes that cannot be distinguished unless the experiment changes. docs/diagnosis.md shows the
/// groups.
struct ConfoundedGroup {
  std::vector<std::string> causes;
  std::string separated_by;  ///< change of the experiment
};
[[nodiscard]] const std::vector<ConfoundedGroup>& confounded_groups();
/// True when two causes are in one group.
[[nodiscard]] bool confounded(const std::string& a, const std::string& b);

/// Parameter of truth and library: library = factor * truth.
struct SharedParameter {
  std::string_view cause, truth, library;
  double factor = 1;
};
[[nodiscard]] std::span<const SharedParameter> shared_parameters();

/// An estimated parameter of a hidden cause, and its true value.
struct Compared {
  std::string cause, parameter;
  double truth = 0, estimate = 0, std_dev = 0;

  [[nodiscard]] bool inside() const;  ///< of the 95 % interval
  [[nodiscard]] bool within_5pc() const;
};
/// Parameters that truth and library have in common.
[[nodiscard]] std::vector<Compared> compared(const Diagnosis& found, const std::vector<HiddenEffect>& answer);

}  // namespace crane::diagnosis::score
