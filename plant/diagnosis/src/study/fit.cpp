#include "study/fit.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parallel.hpp"
#include "study/block_std_dev.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostRounds = 12;  // of Gauss-Newton
/// Largest number of attempts for one group of values in a round, each with more damping than the attempt
/// before. kFewAttempts applies to the values of one effect alone, and while the loss exceeds `loss_to_beat`.
constexpr int kAttempts = 7, kFewAttempts = 3;
constexpr double kFirstDamping = 1e-3;
/// kLeastGain for the values of a verdict, which are then within 0.1 standard deviations of the minimum.
constexpr double kLeastGainOfVerdict = 0.01;
/// The same for the sum of squares: the larger of a number of noise variances and a share of the sum.
constexpr double kLeastGainOfSquares = 3, kLeastShareOfSquares = 1e-4;
/// Pattern search on a rough loss (R. Hooke, T. A. Jeeves, J. ACM 8 (1961) 212): first step as a share of the
/// value; last step as a share of the first; factor after a step that decreases the loss; factor after steps
/// that decrease it in neither direction.
constexpr double kFirstStep = 0.15, kLastStep = 0.1, kLonger = 1.5, kShorter = 0.5;
/// A fit ends before a step whose predicted decrease is less than this share of the least decrease of a
/// round.
constexpr double kWorthAStep = 0.3;
/// From this round on, a fit ends if kDecreaseMargin times the predicted decrease does not bring the loss
/// below `loss_to_beat`.
constexpr int kLeastRounds = 1;
constexpr double kDecreaseMargin = 4;
/// The slopes along effects are computed again only if the decrease of the loss by a step differs from the
/// predicted one by more than this share (gain ratio of a trust region: J. J. Moré, Lect. Notes Math. 630
/// (1978) 105).
constexpr double kAsPredicted = 0.25;

struct Flat {
  std::vector<const FreeParameter*> parameters;
  VectorXd values;
};

Flat flatten(const Effects& effects) {
  Flat flat;
  std::vector<double> values;
  for (const Effect& effect : effects) {
    for (const FreeParameter& p : effect.candidate->parameters) flat.parameters.push_back(&p);
    values.insert(values.end(), effect.values.begin(), effect.values.end());
  }
  flat.values = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
  return flat;
}

bool same_values(const Effects& a, const Effects& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const Effect& x, const Effect& y) { return x.values == y.values; });
}

/// Predicted decrease of the loss by an undamped step without bounds.
double largest_predicted_decrease(const BlockScores& at) {
  return at.gradient().dot(solve(at.curvature, at.gradient()));
}

/// Predicted decrease of the loss by a step.
double predicted_decrease_of(const BlockScores& at, const VectorXd& step) {
  return step.allFinite() ? 2 * at.gradient().dot(step) - step.dot(at.curvature * step) : 0;
}

/// Damped step of the values `active` inside their bounds. A value whose step leads to its bound or beyond
/// is held at the bound, and the step of the others minimises the same parabola beside it (active set).
VectorXd bounded_step(const MatrixXd& h, const VectorXd& g, const Flat& flat, double damping,
                      std::vector<Index> active) {
  VectorXd step = VectorXd::Zero(flat.values.size());
  while (!active.empty()) {
    const VectorXd gradient = g - h * step;  // the steps of active values are 0
    MatrixXd reduced = h(active, active);
    reduced.diagonal() *= 1 + damping;
    const VectorXd moved = solve(reduced, gradient(active));
    std::vector<Index> inside;
    VectorXd next = step;
    for (Index i = 0; i < moved.size(); ++i) {
      const Index at = active[static_cast<std::size_t>(i)];
      const FreeParameter& p = *flat.parameters[static_cast<std::size_t>(at)];
      const double wanted = flat.values[at] + moved[i], kept = std::clamp(wanted, p.low, p.high);
      next[at] = kept - flat.values[at];
      if (kept == wanted) inside.push_back(at);
    }
    if (inside.size() == active.size()) return next;
    for (const Index at : inside) next[at] = 0;
    step = std::move(next);
    active = std::move(inside);
  }
  return step;
}

/// Groups of values that change together in a step: all values; then, if there are several effects, the
/// values of each effect alone, so that an effect with a discontinuous loss does not block the others.
/// @param alone  false: no effect alone
std::vector<std::vector<Index>> step_groups(const Effects& effects, bool alone) {
  std::vector<std::vector<Index>> groups(1);
  Index next = 0;
  for (const Effect& effect : effects) {
    std::vector<Index> own(effect.values.size());
    for (Index& k : own) k = next++;
    groups[0].insert(groups[0].end(), own.begin(), own.end());
    if (alone && effects.size() > 1) groups.push_back(std::move(own));
  }
  return groups;
}

/// Loss including the determinants of the starts.
double total_loss(const Evaluation& at, Loss loss) {
  if (loss == Loss::robust) return at.loss;
  double sum = 0;
  for (const Fits* fits : {&at.drive, &at.load})
    for (const WindowFit& fit : *fits) sum += fit.residual.squaredNorm() + fit.start_log_determinant;
  for (const VectorXd& residual : at.equation_error) sum += residual.squaredNorm();
  return sum;
}

/// Pattern search with decreasing steps. @param hold_bounds  parameters that are usually at a bound stay
void step_around(const WhitenedData& data, Fitted& best, double Evaluation::*loss, bool hold_bounds) {
  const Flat from = flatten(best.effects);
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
    values = flatten(best.effects).values;
    return true;
  };
  while ((steps.array().abs() > least.array()).any()) {
    const VectorXd before = flatten(best.effects).values;
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

/// Initial values of one effect with a rough loss: the best of its rough_starts and of a pattern search by
/// the loss of the load; from there a pattern search by the whole loss, with each parameter that is usually
/// at a bound held at both.
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

/// Number of values of the leading effects, without those of the inaccuracies that follow.
std::size_t own_values(const Effects& effects, std::size_t inaccuracies) {
  std::size_t values = 0;
  for (std::size_t i = 0; i + inaccuracies < effects.size(); ++i) values += effects[i].values.size();
  return values;
}

/// Forgets the slopes along the effects, and those along the inaccuracies in the parts in which the
/// simulation is unlike the one at which they were computed. @param computed_at  this simulation
void forget_old(const WhitenedData& data, const Fitted& best, std::size_t inaccuracies, Slopes& along,
                Simulation& computed_at) {
  const std::size_t own = own_values(best.effects, inaccuracies);
  along.forget(0, own, {true, true});
  if (inaccuracies == 0) return;
  const ShowsIn moved = unlike(data.body(), best.effects, best.train, computed_at);
  along.forget(own, along.size(), moved);
  Simulation now = simulation_of(best.train);
  if (moved.drive) computed_at.drive = std::move(now.drive);
  if (moved.load) computed_at.load = std::move(now.load);
}

}  // namespace

bool descend(const WhitenedData& data, Fitted& best, const Descent& descent, Slopes& along) {
  const auto [loss, loss_to_beat, inaccuracies, least_gain] = descent;
  double damping = kFirstDamping, least = total_loss(best.train, loss);
  const double enough =
      loss == Loss::robust ? least_gain : std::max(kLeastGainOfSquares, kLeastShareOfSquares * least);
  Simulation computed_at = inaccuracies > 0 ? simulation_of(best.train) : Simulation{};
  std::optional<Slopes> here;  // `along`, whitened
  for (int round = 0; round < kMostRounds; ++round) {
    if (!here) {
      along = data.plain_slopes(best.effects, best.train, std::move(along));
      here = data.whitened(along, best.train);
    }
    const BlockScores both = data.scores(best.train, *here, loss);
    if (round >= kLeastRounds && std::isfinite(loss_to_beat)) {
      const double decrease =
          largest_predicted_decrease(loss == Loss::robust ? both : data.scores(best.train, *here));
      if (best.train.loss - kDecreaseMargin * decrease > loss_to_beat) return false;
    }
    const VectorXd gradient = both.gradient();
    const Flat flat = flatten(best.effects);
    double gained = 0;
    bool as_predicted = true;
    const auto groups = step_groups(best.effects, inaccuracies == 0);
    if (predicted_decrease_of(both, bounded_step(both.curvature, gradient, flat, 0, groups[0])) <
        kWorthAStep * enough)
      break;
    for (std::size_t group = 0; group < groups.size() && gained < enough; ++group) {
      const int attempts = group == 0 && best.train.loss <= loss_to_beat ? kAttempts : kFewAttempts;
      bool moves = false;
      for (int attempt = 0; attempt < attempts && !moves; ++attempt) {
        const VectorXd step = bounded_step(both.curvature, gradient, flat, damping, groups[group]);
        if (!step.allFinite() || step.norm() == 0) break;
        const Effects tried = moved(best.effects, step);
        Evaluation found = data.evaluated(tried, best.train);
        const double now = total_loss(found, loss), decrease = predicted_decrease_of(both, step);
        as_predicted = as_predicted && std::abs(least - now - decrease) <= kAsPredicted * decrease;
        if (now < least) {
          moves = true;
          gained += least - now;
          least = now;
          best.effects = tried;
          best.train = std::move(found);
          damping = std::max(1e-6, damping * 0.2);
        } else {
          damping = std::max(damping, 1e-4) * 8;
        }
      }
      if (gained < enough) damping = kFirstDamping;
    }
    if (gained < enough) break;  // converged
    if (as_predicted) continue;
    forget_old(data, best, inaccuracies, along, computed_at);
    here.reset();
  }
  return true;
}

Effects initial_values(const WhitenedData& data, const Effects& effects, const Evaluation& near) {
  return needs_pattern_search(effects) ? search_around(data, effects, near) : effects;
}

Fitted fit(const WhitenedData& data, Effects effects, double loss_to_beat, const Evaluation& near,
           Slopes& along) {
  Fitted start;
  start.effects = std::move(effects);
  start.train = data.evaluated(start.effects, near);
  Fitted best = start;
  if (needs_pattern_search(best.effects)) step_around(data, best, &Evaluation::loss, false);
  if (!same_values(start.effects, best.effects)) along = {};
  along.keep_first(static_cast<std::size_t>(flatten(best.effects).values.size()));
  start = best;
  const bool can_beat = descend(data, best, {.loss = Loss::squares, .loss_to_beat = loss_to_beat}, along);
  if (start.train.loss < best.train.loss) best = start, along = {};
  if (can_beat) descend(data, best, {.loss_to_beat = loss_to_beat}, along);
  along = data.plain_slopes(best.effects, best.train, std::move(along));
  set_block_std_dev(data, data.whitened(along, best.train), {}, best);
  best.nuisance = data.nuisance();
  return best;
}

Fitted fit(const WhitenedData& data, Effects effects, double loss_to_beat, const Evaluation& near) {
  Slopes along;
  return fit(data, std::move(effects), loss_to_beat, near, along);
}

Fitted converged(const WhitenedData& data, Fitted fitted) {
  Slopes along;
  descend(data, fitted, {.least_gain = kLeastGainOfVerdict}, along);
  along = data.plain_slopes(fitted.effects, fitted.train, std::move(along));
  set_block_std_dev(data, data.whitened(along, fitted.train), {}, fitted);
  return fitted;
}

}  // namespace crane::diagnosis
