#include "study/free_values.hpp"

#include <algorithm>

#include "study/blocks.hpp"

namespace crane::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

FreeValues free_values_of(const Effects& effects) {
  FreeValues all;
  std::vector<double> values;
  for (const Effect& effect : effects) {
    for (const FreeParameter& p : effect.candidate->parameters) all.parameters.push_back(&p);
    values.insert(values.end(), effect.values.begin(), effect.values.end());
  }
  all.values = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  return all;
}

bool same_values(const Effects& a, const Effects& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const Effect& x, const Effect& y) { return x.values == y.values; });
}

VectorXd bounded_step(const MatrixXd& h, const VectorXd& g, const FreeValues& free, double damping,
                      std::vector<Index> active) {
  VectorXd step = VectorXd::Zero(free.values.size());
  while (!active.empty()) {
    const VectorXd gradient = g - h * step;  // the steps of active values are 0
    MatrixXd reduced = h(active, active);
    reduced.diagonal() *= 1 + damping;
    const VectorXd moved = solve(reduced, gradient(active));
    std::vector<Index> inside;
    VectorXd next = step;
    for (Index i = 0; i < moved.size(); ++i) {
      const Index at = active[static_cast<std::size_t>(i)];
      const FreeParameter& p = *free.parameters[static_cast<std::size_t>(at)];
      const double wanted = free.values[at] + moved[i], kept = std::clamp(wanted, p.low, p.high);
      next[at] = kept - free.values[at];
      if (kept == wanted) inside.push_back(at);
    }
    if (inside.size() == active.size()) return next;
    for (const Index at : inside) next[at] = 0;
    step = std::move(next);
    active = std::move(inside);
  }
  return step;
}

}  // namespace crane::diagnosis
