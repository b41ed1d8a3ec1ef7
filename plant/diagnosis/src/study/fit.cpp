#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "study/blocks.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostRounds = 12;
/// Largest number of attempts of a round, each with more damping: kFewAttempts for the values of one effect
/// alone, or while the loss exceeds `loss_to_beat`.
constexpr int kAttempts = 7, kFewAttempts = 3;
constexpr double kFirstDamping = 1e-3;
/// A round that decreases the Cauchy loss by less is the last one.
constexpr double kLeastGain = 0.3;
/// The same for the sum of squares, as a share.
constexpr double kRoughly = 0.003;
/// Pattern search on a rough loss (R. Hooke, T. A. Jeeves, J. ACM 8 (1961) 212): first step as a share of the
/// value; last step as a share of the first; factor after a step that decreases the loss; factor after steps
/// that decrease it in neither direction.
constexpr double kFirstStep = 0.15, kLastStep = 0.1, kLonger = 1.5, kShorter = 0.5;
/// From this round on, a fit ends if kPromise times the predicted decrease does not bring the loss below
/// `loss_to_beat`.
constexpr int kLeastRounds = 1;
constexpr double kPromise = 4;
/// Largest number of alternations of fit and noise model, and the decrease of the deviance below which they
/// end.
constexpr int kMostNoiseRounds = 3;
constexpr double kWorthARound = 2;

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
double promised(const BlockScores& at) { return at.pull().dot(solve(at.curvature, at.pull())); }

/// Damped step of the values `active` inside their bounds. A value at its bound whose step leads outwards is
/// held.
VectorXd bounded_step(const MatrixXd& h, const VectorXd& g, const Flat& flat, double damping,
                      std::vector<Index> active) {
  VectorXd step = VectorXd::Zero(flat.values.size());
  for (int round = 0; round < 4 && !active.empty(); ++round) {
    const auto n = static_cast<Index>(active.size());
    MatrixXd reduced(n, n);
    VectorXd pull(n);
    for (Index i = 0; i < n; ++i) {
      pull[i] = g[active[static_cast<std::size_t>(i)]];
      for (Index j = 0; j < n; ++j)
        reduced(i, j) = h(active[static_cast<std::size_t>(i)], active[static_cast<std::size_t>(j)]);
    }
    reduced.diagonal() *= 1 + damping;
    const VectorXd moved = solve(reduced, pull);
    step.setZero();
    std::vector<Index> free;
    for (Index i = 0; i < n; ++i) {
      const Index at = active[static_cast<std::size_t>(i)];
      const FreeParameter& p = *flat.parameters[static_cast<std::size_t>(at)];
      const double wanted = flat.values[at] + moved[i], kept = std::clamp(wanted, p.low, p.high);
      step[at] = kept - flat.values[at];
      if (kept == wanted || step[at] != 0) free.push_back(at);
    }
    if (free.size() == active.size()) break;
    active = free;
  }
  return step;
}

/// Groups of values that are stepped together: all values; then, if there are several effects, the values of
/// each effect alone, so that an effect with a stepped loss does not block the others.
std::vector<std::vector<Index>> moved_together(const Effects& effects) {
  std::vector<std::vector<Index>> groups(1);
  Index next = 0;
  for (const Effect& effect : effects) {
    std::vector<Index> own(effect.values.size());
    for (Index& i : own) i = next++;
    groups[0].insert(groups[0].end(), own.begin(), own.end());
    groups.push_back(std::move(own));
  }
  if (effects.size() == 1) groups.pop_back();
  return groups;
}

ShowsIn shown_in(const Effects& effects) {
  ShowsIn parts;
  for (const Effect& effect : effects) {
    parts.drive = parts.drive || effect.candidate->drive;
    parts.load = parts.load || effect.candidate->load;
  }
  return parts;
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

/// Error of the simulation by output: mean over the windows of the rms error of each.
std::array<double, kOutputs> errors_of(const std::vector<std::pair<const Problem*, const Fits*>>& parts) {
  std::array<double, kOutputs> errors{};
  for (const auto& [problem, fits] : parts)
    for (std::size_t i = 0; i < problem->outputs().size(); ++i) {
      const std::vector<double> squares = problem->squares_left(*fits, i);
      double& error = errors[problem->outputs()[i]];
      for (std::size_t w = 0; w < squares.size(); ++w)
        error += std::sqrt(squares[w] / static_cast<double>(problem->seen_rows(problem->windows()[w], i))) /
                 static_cast<double>(squares.size());
    }
  return errors;
}

}  // namespace

namespace {

/// Schwarz's penalty per value, ln N for N blocks, over Akaike's penalty, 2: the probability that a
/// superfluous value is accepted decreases with the amount of data (G. Schwarz, Ann. Statist. 6 (1978) 461;
/// for composite likelihoods X. Gao, P. X.-K. Song, J. Amer. Statist. Assoc. 105 (2010) 1531).
double schwarz_over_akaike(const Blocks& left_out) {
  const auto blocks = std::count_if(left_out.begin(), left_out.end(), [](double cost) { return cost > 0; });
  return std::max(1.0, 0.5 * std::log(std::max<double>(1, static_cast<double>(blocks))));
}

}  // namespace

bool Study::descend(Fitted& best, Loss loss, double loss_to_beat, std::optional<Slopes>& along) const {
  double damping = kFirstDamping, least = total_loss(best.train, loss);
  for (int round = 0; round < kMostRounds; ++round) {
    if (!along) along = slopes(best.effects, best.train);
    if (round >= kLeastRounds &&
        best.train.loss - kPromise * promised(block_scores(best.train, *along)) > loss_to_beat)
      return false;
    const BlockScores both = block_scores(best.train, *along, loss);
    const VectorXd pull = both.pull();
    const Flat flat = flatten(best.effects);
    double gained = 0;
    const auto groups = moved_together(best.effects);
    for (std::size_t group = 0; group < groups.size() && gained == 0; ++group) {
      const int attempts = group == 0 && best.train.loss <= loss_to_beat ? kAttempts : kFewAttempts;
      for (int attempt = 0; attempt < attempts && gained == 0; ++attempt) {
        const VectorXd step = bounded_step(both.curvature, pull, flat, damping, groups[group]);
        if (!step.allFinite() || step.norm() == 0) break;
        const Effects tried = moved(best.effects, step);
        Evaluation found = evaluate(train_, tried, best.train);
        const double now = total_loss(found, loss);
        if (now < least) {
          gained = least - now;
          least = now;
          best.effects = tried;
          best.train = std::move(found);
          along.reset();
          damping = std::max(1e-6, damping * 0.2);
        } else {
          damping = std::max(damping, 1e-4) * 8;
        }
      }
      if (gained == 0) damping = kFirstDamping;
    }
    if (gained < (loss == Loss::robust ? kLeastGain : kRoughly * least)) break;
  }
  return true;
}

void Study::step_around(Fitted& best, double Evaluation::*loss) const {
  const Flat from = flatten(best.effects);
  VectorXd values = from.values, steps(values.size());
  for (Index i = 0; i < steps.size(); ++i)
    steps[i] =
        std::max(kFirstStep * std::abs(values[i]), 0.5 * from.parameters[static_cast<std::size_t>(i)]->step);
  const VectorXd least = kLastStep * steps;
  const auto better = [&](const VectorXd& step) {
    Fitted tried;
    tried.effects = moved(best.effects, step);
    if (same_values(tried.effects, best.effects)) return false;
    tried.train = evaluate(train_, tried.effects, best.train);
    if (tried.train.*loss >= best.train.*loss - kLeastGain) return false;
    best = std::move(tried);
    values = flatten(best.effects).values;
    return true;
  };
  while ((steps.array().abs() > least.array()).any()) {
    const VectorXd before = flatten(best.effects).values;
    for (Index i = 0; i < steps.size(); ++i) {
      const VectorXd step = steps[i] * VectorXd::Unit(steps.size(), i);
      if (better(step))
        steps[i] *= kLonger;
      else
        steps[i] *= better(-step) ? -kLonger : kShorter;
    }
    const VectorXd way = values - before;
    while (way.norm() > 0 && better(way)) {
    }
  }
}

Blocks Study::deviance_of(const Body& body, const Evaluation& at) {
  Blocks deviance = at.blocks;
  const auto add = [&deviance](std::size_t first, const Blocks& more) {
    for (std::size_t i = 0; i < more.size(); ++i) deviance[first + i] += more[i];
  };
  add(0, log_variances_of(body.drive));
  const std::vector<double> of_pieces = body.equation_error.log_variances();
  for (std::size_t i = 0; i < of_pieces.size(); ++i)
    deviance[body.equation_error.windows()[i]] += of_pieces[i];
  add(at.drive_blocks, log_variances_of(body.load));
  return deviance;
}

void Study::judge_by_likelihood(Fitted& fitted) const {
  fitted.noise = noise();
  fitted.deviance = deviance_of(train_, fitted.train);
  const double schwarz = schwarz_over_akaike(fitted.left_out);
  for (std::size_t i = 0; i < fitted.left_out.size(); ++i) fitted.deviance[i] += schwarz * fitted.left_out[i];
  fitted.penalty = schwarz * sum(fitted.left_out);
  fitted.error = errors_of({{&train_.drive, &fitted.train.drive}, {&train_.load, &fitted.train.load}});
  if (whole_runs_.empty()) return;
  const Fits whole = whole_runs_.fit(replays_of(train_.runs, with(fitted.effects)));
  fitted.whole_error = errors_of({{&whole_runs_, &whole}});
}

Blocks Study::held_out_deviance(const Fitted& fitted) {
  whiten_test(fitted.noise);
  return deviance_of(test_, evaluated(test_, replays_of(test_.runs, with(fitted.effects))));
}

Fitted Study::base_model() const {
  Fitted base;
  base.train = base_train_;
  base.first_noise = noise_of(base);
  judge_by_likelihood(base);
  return base;
}

Noise Study::noise_of(const Fitted& fitted, const Noise& unchanged) const {
  const ShowsIn parts = shown_in(fitted.effects);
  Noise noise = unchanged;
  if (!train_.drive.empty() && (parts.drive || unchanged.drive.empty())) {
    noise.drive = train_.drive.disturbances_of(fitted.train.drive);
    noise.equation_error =
        train_.equation_error.disturbances_of(replays_of(train_.runs, with(fitted.effects)));
  }
  if (!train_.load.empty() && (parts.load || unchanged.load.empty()))
    noise.load = train_.load.disturbances_of(fitted.train.load);
  return noise;
}

Fitted Study::first_fit(const Effects& effects, const Fitted& near) const {
  Fitted fitted = fit(effects, near.train.loss - kLeastGain, near.train);
  fitted.first_noise = noise_of(fitted, near.first_noise);
  for (const auto* of :
       {&fitted.first_noise.drive, &fitted.first_noise.equation_error, &fitted.first_noise.load})
    for (const Disturbance& disturbance : *of) fitted.misfit += disturbance.misfit;
  return fitted;
}

Fitted Study::refit_with_own_noise(const Fitted& first_fit) {
  Fitted best = first_fit, last = first_fit;
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostNoiseRounds; ++round) {
    const Noise noise = round == 0 ? first_fit.first_noise : noise_of(last);
    whiten_training(noise);
    last = fit(last.effects, std::numeric_limits<double>::infinity(), evaluated_again(last));
    judge_by_likelihood(last);
    last.misfit = first_fit.misfit;
    last.first_noise = first_fit.first_noise;
    const double gained = least - sum(last.deviance);
    if (!(gained > 0)) break;
    best = last;
    least -= gained;
    if (gained < kWorthARound) break;
  }
  whiten_training(best.noise);
  return best;
}

Fitted Study::fit(Effects effects, double loss_to_beat) const {
  return fit(std::move(effects), loss_to_beat, base_train_);
}

Fitted Study::fit(Effects effects, double loss_to_beat, const Evaluation& near) const {
  Fitted start;
  start.effects = std::move(effects);
  start.train = train(start.effects, near);
  Fitted best = start;
  if (best.effects.size() == 1 && best.effects[0].candidate->rough) {
    if (!train_.load.empty()) step_around(best, &Evaluation::load_loss);
    step_around(best, &Evaluation::loss);
  }
  start = best;
  std::optional<Slopes> along;
  const bool hope = descend(best, Loss::squares, loss_to_beat, along);
  if (start.train.loss < best.train.loss) best = start, along.reset();
  if (hope) descend(best, Loss::robust, loss_to_beat, along);
  if (!along) along = slopes(best.effects, best.train);
  const BlockScores both = block_scores(best.train, *along);
  best.left_out = left_out(both);
  const MatrixXd inverse = both.curvature.completeOrthogonalDecomposition().pseudoInverse();
  best.by_noise = inverse.diagonal().cwiseMax(0.0).cwiseSqrt();
  // The replay and the equation error of a drive contain the same noise: together they have the information
  // of one of them.
  Index value = 0;
  for (const Effect& effect : best.effects)
    for (std::size_t k = 0; k < effect.values.size(); ++k, ++value)
      if (effect.candidate->drive) best.by_noise[value] *= std::numbers::sqrt2;
  best.covariance = inverse * (both.by_block.transpose() * both.by_block) * inverse;
  for (const double variance : best.covariance.diagonal())
    best.std_dev.push_back(std::sqrt(std::max(0.0, variance)));
  best.parameters = best.std_dev.size();
  best.noise = noise();
  return best;
}

}  // namespace crane::diagnosis
