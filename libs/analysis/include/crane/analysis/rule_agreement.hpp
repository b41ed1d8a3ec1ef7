#pragma once
/// Compares two fuzzy rule tables.
#include <cstddef>
#include <cstdlib>

#include "crane/control/fuzzy.hpp"

namespace crane::analysis {

struct RuleAgreement {
  int rules = 0;       ///< number of rules
  int exact = 0;       ///< number of rules with equal labels
  int within_one = 0;  ///< number of rules with equal or neighbouring labels
};

[[nodiscard]] inline RuleAgreement agreement(const control::FuzzyRules& a,
                                             const control::FuzzyRules& b) noexcept {
  RuleAgreement result;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < a[i].size(); ++j) {
      const int distance = std::abs(a[i][j] - b[i][j]);
      ++result.rules;
      result.exact += distance == 0;
      result.within_one += distance <= 1;
    }
  return result;
}

}  // namespace crane::analysis
