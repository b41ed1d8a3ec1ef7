#include "replay/standstill.hpp"

#include <algorithm>

#include "crane/plant/term.hpp"

namespace crane::diagnosis {

Crane holding(Crane crane) {
  for (plant::TermSetting& term : crane.terms) {
    const plant::TermKind* kind = plant::find_term(term.name);
    const plant::TermParameter* smoothing =
        kind != nullptr ? plant::find_parameter(*kind, "smoothing_speed") : nullptr;
    if (smoothing == nullptr) continue;
    double& speed = term.parameters.try_emplace("smoothing_speed", smoothing->default_value).first->second;
    speed = std::min(speed, kHoldingSpeed);
  }
  return crane;
}

}  // namespace crane::diagnosis
