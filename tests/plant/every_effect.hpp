#pragma once
/// One setting of each term.
#include <vector>

#include "crane/plant/term.hpp"

namespace crane::test {

/// The examples of all terms, and a gap of the slew axis: the equations of both axes of a backlash differ.
inline std::vector<plant::TermSetting> every_effect() {
  std::vector<plant::TermSetting> effects;
  for (const plant::TermKind& kind : plant::term_kinds()) effects.push_back(kind.example);
  effects.push_back({"backlash", "slew", {{"gap", 0.01}}});
  return effects;
}

}  // namespace crane::test
