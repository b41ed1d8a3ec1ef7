#pragma once
/// A finding of the doctor: one line, with the remedy.
#include <cstdint>
#include <string>
#include <vector>

namespace crane::doctor {

enum class Grade : std::uint8_t {
  good,    ///< checked, no action needed
  advice,  ///< works, but could fail under load or later
  problem  ///< does not work; `crane doctor` exits with code 1
};

struct Finding {
  Grade grade = Grade::good;
  std::string area;    ///< area of the check: "net", "rt", "hw"
  std::string code;    ///< lower_snake name, stable for scripts
  std::string what;    ///< one line
  std::string remedy;  ///< empty for Grade::good
};
using Findings = std::vector<Finding>;

[[nodiscard]] const char* name_of(Grade grade);
/// "problem  net  WHAT: REMEDY"
[[nodiscard]] std::string line_of(const Finding& finding);

}  // namespace crane::doctor
