#include "study/own_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace crane::diagnosis {
namespace {

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

std::array<double, kOutputs> errors_of(const Body& body, const Evaluation& at) {
  return mean_errors({{&body.drive, &at.drive}, {&body.load, &at.load}});
}

/// Rms change of the outputs in windows when `effect` is omitted, from the starts of the fit, m or rad.
std::array<double, kOutputs> change_by(const Study& study, const Fitted& fitted, std::size_t effect) {
  Effects others = fitted.effects;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(effect));
  // An inaccuracy of the same cause stays out: its value was fitted before the effect.
  const Crane crane = study.crane(calibration_beside(fitted.nuisance.inaccuracies, fitted.effects), others);
  const Body& body = study.train();
  const Replays without = replays_of(body.runs, crane);
  std::array<double, kOutputs> change{};
  for (const auto& [problem, fits] :
       {std::pair{&body.drive, &fitted.train.drive}, {&body.load, &fitted.train.load}}) {
    if (fits->empty()) continue;
    const std::vector<std::vector<double>> squares = problem->squares_changed(without, *fits);
    for (std::size_t i = 0; i < problem->outputs().size(); ++i) {
      double of_output = 0, rows = 0;
      for (std::size_t w = 0; w < squares.size(); ++w) {
        of_output += squares[w][i];
        rows += static_cast<double>(problem->measured_rows(problem->windows()[w], i));
      }
      change[problem->outputs()[i]] = std::sqrt(of_output / rows);
    }
  }
  return change;
}

/// Sets the errors of a fit, and the changes by its effects.
void set_sizes(const Study& study, Fitted& fitted) {
  fitted.error = errors_of(study.train(), fitted.train);
  fitted.change.clear();
  for (std::size_t i = 0; i < fitted.effects.size(); ++i)
    fitted.change.push_back(change_by(study, fitted, i));
  if (study.whole_runs().empty()) return;
  const Crane crane = study.crane(fitted.nuisance.inaccuracies, fitted.effects);
  const Fits whole = study.whole_runs().fit(replays_of(study.train().runs, crane));
  fitted.whole_error = mean_errors({{&study.whole_runs(), &whole}});
}

/// Sets the deviance in the noise of the data.
void set_deviance(const WhitenedData& data, Fitted& fitted) {
  fitted.deviance = deviance_of(data.body(), fitted.train);
  const double schwarz = schwarz_over_akaike(fitted.left_out);
  for (std::size_t i = 0; i < fitted.left_out.size(); ++i) fitted.deviance[i] += schwarz * fitted.left_out[i];
  fitted.penalty = schwarz * sum(fitted.left_out);
}

/// Noise of the residuals of a fit, with its inaccuracies; `unchanged` in the parts in which none of its
/// effects is visible. @param data in any noise @param near noise with which the search begins; empty: none
/// is known
Nuisance own_nuisance(const WhitenedData& data, const Fitted& fitted, const Nuisance& unchanged = {},
                      const Nuisance& near = {}) {
  const ShowsIn parts = shown_in(fitted.effects);
  Nuisance found = unchanged;
  if (!data.drive().empty() && (parts.drive || unchanged.drive.empty())) {
    const Crane crane = data.study().crane(fitted.nuisance.inaccuracies, fitted.effects);
    found.drive = data.drive().disturbances_of(fitted.train.drive, near.drive);
    found.equation_error =
        data.body().equation_error.disturbances_of(replays_of(data.runs(), crane), near.equation_error);
  }
  if (!data.load().empty() && (parts.load || unchanged.load.empty()))
    found.load = data.load().disturbances_of(fitted.train.load, near.load);
  found.inaccuracies = fitted.nuisance.inaccuracies;
  return found;
}

/// True if fit_jointly() suffices when only the noise model has changed.
bool fitted_jointly(const Fitted& fitted) {
  return !needs_pattern_search(fitted.effects) &&
         !visible_beside(fitted.nuisance.inaccuracies, fitted.effects).empty();
}

}  // namespace

Nuisance learnt_nuisance(const Study& study, const Effects& effects) {
  const Body body(study.train(),
                  replays_of(study.train().runs, study.crane(study.no_inaccuracies(), effects)));
  return {body.drive.disturbances(), body.equation_error.disturbances(), body.load.disturbances(),
          study.no_inaccuracies()};
}

BaseModel learnt_base_model(const Study& study) {
  BaseModel base;
  base.exact = learnt_nuisance(study);
  auto data = std::make_unique<const WhitenedData>(study, base.exact);
  Fitted fitted;
  fitted.train = data->base();
  base.slopes.simulation = simulation_of(fitted.train);
  double least = sum(deviance_of(data->body(), fitted.train));
  Slopes along;
  for (int round = 0; round < kMostNoiseRounds; ++round) {
    fit_jointly(*data, {}, fitted, along);
    auto next = std::make_unique<const WhitenedData>(study, own_nuisance(*data, fitted, {}, fitted.nuisance));
    fitted.train = next->base();
    const double gained = least - sum(deviance_of(next->body(), fitted.train));
    if (gained < 0) break;
    data = std::move(next);
    base.slopes.simulation = simulation_of(fitted.train);
    if (gained < kWorthARound) break;
    least -= gained;
  }
  base.calibrated = data->nuisance();
  for (std::size_t i = 0; i < along.size(); ++i) base.slopes.of_values.push_back(along.of_value(i));
  return base;
}

Fitted base_fit(const WhitenedData& data) {
  Fitted base;
  base.train = data.base();
  base.nuisance = data.nuisance();
  base.first_nuisance = own_nuisance(data, base);
  set_deviance(data, base);
  set_sizes(data.study(), base);
  return base;
}

Fitted first_fit(const WhitenedData& data, const Effects& effects, const Fitted& near) {
  const Effects from = initial_values(data, effects, near.train);
  Fitted fitted = fit(data, from, near.train.loss - kLeastGain, near.train);
  fitted.error = errors_of(data.body(), fitted.train);
  fitted.first_nuisance = own_nuisance(data, fitted, near.first_nuisance);
  for (const auto* of :
       {&fitted.first_nuisance.drive, &fitted.first_nuisance.equation_error, &fitted.first_nuisance.load})
    for (const Disturbance& disturbance : *of) fitted.misfit += disturbance.misfit;
  return fitted;
}

Fitted refit_with_own_noise(const Study& study, const BaseModel& base, const Fitted& first_fit) {
  Fitted best = first_fit, last = first_fit;
  double least = std::numeric_limits<double>::infinity();
  // The noise changes from round to round; slopes before whitening are known until the values change.
  Slopes along;
  Nuisance nuisance = first_fit.first_nuisance;
  for (int round = 0; round < kMostNoiseRounds; ++round) {
    const WhitenedData data(study, nuisance);
    last.train = data.evaluated_again(last);
    // Later rounds begin near their result: the joint fit suffices.
    if (round == 0 || !fitted_jointly(last))
      last = fit(data, last.effects, kNothingToBeat, last.train, along);
    fit_jointly(data, base.slopes, last, along);
    set_deviance(data, last);
    last.misfit = first_fit.misfit;
    last.first_nuisance = first_fit.first_nuisance;
    const double gained = least - sum(last.deviance);
    if (!(gained > 0)) break;
    best = last;
    least = sum(last.deviance);
    if (gained < kWorthARound) break;
    nuisance = own_nuisance(data, last, last.nuisance, last.nuisance);
  }
  set_sizes(study, best);
  return best;
}

Blocks held_out_deviance(const Study& study, const Fitted& fitted) {
  const Runs& runs = study.test().runs;
  const Replays crane = replays_of(runs, study.crane(fitted.nuisance.inaccuracies, fitted.effects)),
                any = replays_of(runs, study.base());
  const Body in_noise_of_training(study.test(), fitted.nuisance, any);
  const Body body(study.test(), noise_of(in_noise_of_training, evaluated(in_noise_of_training, crane), crane),
                  any);
  return deviance_of(body, evaluated(body, crane));
}

}  // namespace crane::diagnosis
