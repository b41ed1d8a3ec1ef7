#pragma once
/// What the doctor says: one line each, with the remedy.
#include <cstdint>
#include <string>
#include <vector>

namespace crane::doctor {

enum class Grade : std::uint8_t {
  good,    ///< checked, nothing to do
  advice,  ///< works, and could fail under load or later
  problem  ///< does not work; `crane doctor` then ends with 1
};

struct Finding {
  Grade grade = Grade::good;
  std::string room;    ///< "net", "rt", "hw"
  std::string code;    ///< lower_snake name, stable for scripts
  std::string what;    ///< one line
  std::string remedy;  ///< empty for Grade::good
};
using Findings = std::vector<Finding>;

[[nodiscard]] const char* name_of(Grade grade);
/// "problem  net  WHAT: REMEDY"
[[nodiscard]] std::string line_of(const Finding& finding);

}  // namespace crane::doctor
