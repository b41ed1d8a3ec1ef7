#include "study/hypothesis.hpp"

#include <algorithm>
#include <numeric>

namespace crane::diagnosis {

double sum(const Blocks& blocks) { return std::accumulate(blocks.begin(), blocks.end(), 0.0); }

ShowsIn shown_in(const Effects& effects) {
  ShowsIn parts;
  for (const Effect& effect : effects) {
    parts.drive = parts.drive || effect.candidate->drive;
    parts.load = parts.load || effect.candidate->load;
  }
  return parts;
}

bool needs_pattern_search(const Effects& effects) {
  return effects.size() == 1 && effects[0].candidate->rough;
}

Effects moved(Effects effects, const Eigen::VectorXd& step) {
  Eigen::Index i = 0;
  for (Effect& effect : effects)
    for (std::size_t k = 0; k < effect.values.size(); ++k, ++i) {
      const FreeParameter& p = effect.candidate->parameters[k];
      effect.values[k] = std::clamp(effect.values[k] + step[i], p.low, p.high);
    }
  return effects;
}

}  // namespace crane::diagnosis
