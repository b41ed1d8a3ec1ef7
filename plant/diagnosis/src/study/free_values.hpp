#pragma once
/// The values of effects as one vector, with their bounds and steps.
#include <algorithm>
#include <vector>

#include "study/hypothesis.hpp"

namespace crane::diagnosis {

struct FreeValues {
  std::vector<const FreeParameter*> parameters;
  Eigen::VectorXd values;
};

[[nodiscard]] inline FreeValues free_values_of(const Effects& effects) {
  FreeValues all;
  std::vector<double> values;
  for (const Effect& effect : effects) {
    for (const FreeParameter& p : effect.candidate->parameters) all.parameters.push_back(&p);
    values.insert(values.end(), effect.values.begin(), effect.values.end());
  }
  all.values = Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  return all;
}

/// @pre the same candidates
[[nodiscard]] inline bool same_values(const Effects& a, const Effects& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const Effect& x, const Effect& y) { return x.values == y.values; });
}

}  // namespace crane::diagnosis
