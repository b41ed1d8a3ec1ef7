#include "study/pattern_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "parallel.hpp"
#include "study/descent.hpp"
#include "study/free_values.hpp"

namespace crane::diagnosis {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// First step as a share of the value; last step as a share of the first; factor after a step that decreases
/// the loss; factor after steps that decrease it in neither direction.
constexpr double kFirstStep = 0.15, kLastStep = 0.1, kLonger = 1.5, kShorter = 0.5;

}  // namespace

void step_around(const WhitenedData& data, Fitted& best, double Evaluation::*loss, bool hold_bounds) {
  const FreeValues from = free_values_of(best.effects);
  VectorXd values = from.values, steps(values.size());
  for (Index i = 0; i < steps.size(); ++i)
    steps[i] =
        std::max(kFirstStep * std::abs(values[i]), 0.5 * from.parameters[static_cast<std::size_t>(i)]->step);
  if (hold_bounds)
    for (Index i = 0; i < steps.size(); ++i)
      if (from.parameters[static_cast<std::size_t>(i)]->often_at_bound) steps[i] = 0;
  const VectorXd least = kLastStep * steps;
  const auto better = [&](const VectorXd& step) {
    Fitted tried;
    tried.effects = moved(best.effects, step);
    if (same_values(tried.effects, best.effects)) return false;
    tried.train = data.evaluated(tried.effects, best.train);
    if (tried.train.*loss >= best.train.*loss - kLeastGain) return false;
    best = std::move(tried);
    values = free_values_of(best.effects).values;
    return true;
  };
  while ((steps.array().abs() > least.array()).any()) {
    const VectorXd before = free_values_of(best.effects).values;
    for (Index i = 0; i < steps.size(); ++i) {
      if (steps[i] == 0) continue;
      const VectorXd step = steps[i] * VectorXd::Unit(steps.size(), i);
      if (better(step))
        steps[i] *= kLonger;
      else
        steps[i] *= better(-step) ? -kLonger : kShorter;
    }
    const VectorXd pattern = values - before;
    while (pattern.norm() > 0 && better(pattern)) {
    }
  }
}

Effects search_around(const WhitenedData& data, const Effects& effects, const Evaluation& near) {
  Fitted best;
  best.effects = effects;
  best.train = data.evaluated(effects, near);
  if (!data.load().empty()) step_around(data, best, &Evaluation::load_loss, true);
  const Candidate* candidate = effects[0].candidate;
  std::vector<Fitted> others(candidate->rough_starts.size());
  parallel_for(others.size(), [&](std::size_t i) {
    others[i].effects = {{candidate, candidate->rough_starts[i]}};
    others[i].train = data.evaluated(others[i].effects, near);
  });
  for (Fitted& other : others)
    if (other.train.loss < best.train.loss) best = std::move(other);
  const Fitted start = best;
  const std::vector<FreeParameter>& parameters = candidate->parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (!parameters[i].often_at_bound) continue;
    best.train.loss = std::numeric_limits<double>::infinity();
    for (const double bound : {parameters[i].low, parameters[i].high}) {
      Fitted held = start;
      held.effects[0].values[i] = bound;
      held.train = data.evaluated(held.effects, start.train);
      step_around(data, held, &Evaluation::loss, true);
      if (held.train.loss < best.train.loss) best = std::move(held);
    }
  }
  return best.effects;
}

}  // namespace crane::diagnosis
