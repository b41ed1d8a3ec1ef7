#include "doctor/finding.hpp"

#include <array>

namespace crane::doctor {

const char* name_of(Grade grade) {
  constexpr std::array kNames{"good", "advice", "problem"};
  return kNames[static_cast<std::size_t>(grade)];
}

std::string line_of(const Finding& finding) {
  std::string grade = name_of(finding.grade);
  grade.resize(9, ' ');
  return grade + finding.area + "  " + finding.what + (finding.remedy.empty() ? "" : ": " + finding.remedy);
}

}  // namespace crane::doctor
