#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "study/blocks.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::VectorXd;

/// Mean over the windows of the rms error of each.
std::array<double, kOutputs> mean_errors(const std::vector<std::pair<const Problem*, const Fits*>>& parts) {
  std::array<double, kOutputs> errors{};
  for (const auto& [problem, fits] : parts)
    for (std::size_t i = 0; i < problem->outputs().size(); ++i) {
      const std::vector<double> squares = problem->squares_left(*fits, i);
      double& error = errors[problem->outputs()[i]];
      for (std::size_t w = 0; w < squares.size(); ++w)
        error +=
            std::sqrt(squares[w] / static_cast<double>(problem->measured_rows(problem->windows()[w], i))) /
            static_cast<double>(squares.size());
    }
  return errors;
}

/// Schwarz's penalty per value, ln N for N blocks, over Akaike's penalty, 2: the probability that a
/// superfluous value is accepted decreases with the amount of data (G. Schwarz, Ann. Statist. 6 (1978) 461;
/// for composite likelihoods X. Gao, P. X.-K. Song, J. Amer. Statist. Assoc. 105 (2010) 1531).
double schwarz_over_akaike(const Blocks& left_out) {
  const auto blocks = std::count_if(left_out.begin(), left_out.end(), [](double cost) { return cost > 0; });
  return std::max(1.0, 0.5 * std::log(std::max<double>(1, static_cast<double>(blocks))));
}

}  // namespace

Nuisance Study::nuisance_in(const Body& body, const Evaluation& at, const Replays& crane) {
  Nuisance nuisance;
  if (!body.drive.empty()) {
    nuisance.drive = body.drive.disturbances_of(at.drive);
    nuisance.equation_error = body.equation_error.disturbances_of(crane);
  }
  if (!body.load.empty()) nuisance.load = body.load.disturbances_of(at.load);
  return nuisance;
}

Blocks Study::deviance_of(const Body& body, const Evaluation& at) {
  Blocks deviance = at.blocks;
  for (double& block : deviance) block /= kLossPerDeviance;
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
  fitted.nuisance = nuisance();
  fitted.deviance = deviance_of(train_, fitted.train);
  const double schwarz = schwarz_over_akaike(fitted.left_out);
  for (std::size_t i = 0; i < fitted.left_out.size(); ++i) fitted.deviance[i] += schwarz * fitted.left_out[i];
  fitted.penalty = schwarz * sum(fitted.left_out);
}

void Study::set_sizes(Fitted& fitted) const {
  fitted.error = errors_of(fitted.train);
  fitted.change.clear();
  for (std::size_t i = 0; i < fitted.effects.size(); ++i) fitted.change.push_back(change_by(fitted, i));
  if (whole_runs_.empty()) return;
  const Fits whole = whole_runs_.fit(replays_of(train_.runs, with(fitted.effects)));
  fitted.whole_error = mean_errors({{&whole_runs_, &whole}});
}

std::array<double, kOutputs> Study::errors_of(const Evaluation& at) const {
  return mean_errors({{&train_.drive, &at.drive}, {&train_.load, &at.load}});
}

std::array<double, kOutputs> Study::change_by(const Fitted& fitted, std::size_t effect) const {
  Effects others = fitted.effects;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(effect));
  // An inaccuracy of the same cause stays out: its value was fitted before the effect.
  const Crane crane = crane_with(calibration_beside(fitted.effects), others);
  const Replays without = replays_of(train_.runs, crane);
  std::array<double, kOutputs> change{};
  for (const auto& [problem, fits] :
       {std::pair{&train_.drive, &fitted.train.drive}, {&train_.load, &fitted.train.load}}) {
    if (problem->empty()) continue;
    const std::vector<double> squares = problem->squares_changed(without, *fits);
    for (std::size_t i = 0; i < squares.size(); ++i) {
      double rows = 0;
      for (const Window& window : problem->windows())
        rows += static_cast<double>(problem->measured_rows(window, i));
      change[problem->outputs()[i]] = std::sqrt(squares[i] / rows);
    }
  }
  return change;
}

Blocks Study::held_out_deviance(const Fitted& fitted) {
  const Effects present = std::exchange(inaccuracies_, fitted.nuisance.inaccuracies);
  const Replays crane = replays_of(test_.runs, with(fitted.effects));
  inaccuracies_ = present;
  whiten_test(fitted.nuisance);
  whiten_test(nuisance_in(test_, evaluated(test_, crane), crane));
  return deviance_of(test_, evaluated(test_, crane));
}

Fitted Study::base_model() const {
  Fitted base;
  base.train = base_train_;
  base.first_nuisance = nuisance_of(base);
  judge_by_likelihood(base);
  set_sizes(base);
  return base;
}

Nuisance Study::nuisance_of(const Fitted& fitted, const Nuisance& unchanged, const Nuisance& near) const {
  const ShowsIn parts = shown_in(fitted.effects);
  Nuisance found = unchanged;
  if (!train_.drive.empty() && (parts.drive || unchanged.drive.empty())) {
    found.drive = train_.drive.disturbances_of(fitted.train.drive, near.drive);
    found.equation_error =
        train_.equation_error.disturbances_of(replays_of(train_.runs, with(fitted.effects)));
  }
  if (!train_.load.empty() && (parts.load || unchanged.load.empty()))
    found.load = train_.load.disturbances_of(fitted.train.load, near.load);
  found.inaccuracies = inaccuracies_;
  return found;
}

bool Study::fitted_jointly(const Effects& effects) const {
  return !needs_pattern_search(effects) && !visible_inaccuracies_beside(effects).empty();
}

Fitted Study::refit_with_own_noise(const Fitted& first_fit) {
  Fitted best = first_fit, last = first_fit;
  double least = std::numeric_limits<double>::infinity();
  // The noise changes from round to round; slopes before whitening are known until the values change.
  Slopes along;
  for (int round = 0; round < kMostNoiseRounds; ++round) {
    whiten_training(round == 0 ? first_fit.first_nuisance : nuisance_of(last, last.nuisance, last.nuisance));
    last.train = evaluated_again(last);
    // Later rounds begin near their result: the joint fit suffices.
    if (round == 0 || !fitted_jointly(last.effects))
      last = fit(last.effects, std::numeric_limits<double>::infinity(), last.train, along);
    fit_inaccuracies(last, along);
    judge_by_likelihood(last);
    last.misfit = first_fit.misfit;
    last.first_nuisance = first_fit.first_nuisance;
    const double gained = least - sum(last.deviance);
    if (!(gained > 0)) break;
    best = last;
    least = sum(last.deviance);
    if (gained < kWorthARound) break;
  }
  whiten_training(best.nuisance);
  set_sizes(best);
  return best;
}

}  // namespace crane::diagnosis
