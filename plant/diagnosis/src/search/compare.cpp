#include "search/compare.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "rules.hpp"
#include "search/block_votes.hpp"

namespace crane::diagnosis {
namespace {

using Errors = std::array<double, kOutputs> Fitted::*;

double largest_reduction(const Fitted& fitted, const Fitted& before, std::initializer_list<Errors> kinds) {
  double most = 0;
  for (std::size_t output = 0; output < kOutputs; ++output) {
    const bool acts = std::ranges::any_of(fitted.effects, [&](const Effect& effect) {
      return !has(before.effects, effect.candidate) && effect.candidate->acts_on(static_cast<Output>(output));
    });
    if (!acts) continue;
    for (const Errors errors : kinds)
      if (const double left = (before.*errors)[output]; left > 0)
        most = std::max(most, 1 - (fitted.*errors)[output] / left);
  }
  return most;
}

}  // namespace

double share_of_error(const Fitted& fitted, const Fitted& before) {
  return largest_reduction(fitted, before, {&Fitted::error, &Fitted::whole_error});
}

double share_of_error_in_windows(const Fitted& fitted, const Fitted& before) {
  return largest_reduction(fitted, before, {&Fitted::error});
}

bool has(const Effects& effects, const Candidate* candidate) {
  return std::any_of(effects.begin(), effects.end(),
                     [&](const Effect& e) { return e.candidate == candidate; });
}

std::string label_of(const Effects& effects) {
  std::string label;
  for (const Effect& effect : effects) label += (label.empty() ? "" : " + ") + effect.candidate->label();
  return label;
}

namespace {

/// Deviance, with kRarerCause for each rarer cause.
double judged_deviance(const Fitted& fitted) {
  const auto rarer = std::ranges::count_if(
      fitted.effects, [](const Effect& effect) { return !effect.candidate->rarer_than.empty(); });
  return sum(fitted.deviance) + rules::kRarerCause * static_cast<double>(rarer);
}

}  // namespace

bool less(const Fitted& a, const Fitted& b) { return judged_deviance(a) < judged_deviance(b); }

bool differs_by_rarer_causes(const Effects& rival, const Effects& best) {
  return std::ranges::all_of(rival, [&](const Effect& effect) {
    const Candidate& candidate = *effect.candidate;
    return has(best, &candidate) || std::ranges::any_of(best, [&](const Effect& common) {
             return common.candidate->cause == candidate.rarer_than &&
                    common.candidate->axis == candidate.axis;
           });
  });
}

bool likelier_without_penalty(const Fitted& a, const Fitted& b) {
  return sum(a.deviance) - a.penalty < sum(b.deviance) - b.penalty;
}

bool same(const Effects& a, const Effects& b) {
  return a.size() == b.size() &&
         std::all_of(a.begin(), a.end(), [&](const Effect& e) { return has(b, e.candidate); });
}

namespace {

double additional_values(const Fitted& fitted, const Fitted& before) {
  const std::size_t more = fitted.parameters - std::min(fitted.parameters, before.parameters);
  return static_cast<double>(std::max<std::size_t>(1, more));
}

/// Dispersion of a composite likelihood: half of the additional Takeuchi penalty per additional value,
/// tr(H^-1 G) / q. 1 for a likelihood; about 2 for two losses of the same data that are added.
double dispersion(const Fitted& fitted, const Fitted& before) {
  const double penalty = sum(fitted.left_out) - sum(before.left_out);
  return std::max(1.0, 0.5 * penalty / additional_values(fitted, before));
}

/// P(chi-square > ratio / dispersion), with the number of additional values as degrees of freedom.
double chance_of(double ratio, const Fitted& fitted, const Fitted& before) {
  if (!(ratio > 0)) return 1;
  const double freedom = additional_values(fitted, before);
  return boost::math::gamma_q(0.5 * freedom, 0.5 * ratio / dispersion(fitted, before));
}

}  // namespace

double likelihood_ratio_p_value(const Fitted& fitted, const Fitted& before, double held_out_nats) {
  const double ratio = (sum(before.deviance) - before.penalty) - (sum(fitted.deviance) - fitted.penalty);
  return chance_of(ratio + 2 * held_out_nats, fitted, before);
}

double held_out_loss_p_value(const Fitted& fitted, const Fitted& before, double held_out_nats) {
  return chance_of(-2 * held_out_nats, fitted, before);
}

double wald_p_value(const Fitted& fitted) {
  double most = 0;
  std::size_t first = 0;
  for (const Effect& effect : fitted.effects) {
    double surest = 0;
    for (std::size_t k = 0; k < effect.candidate->amount_count; ++k) {
      const double distance = std::abs(effect.values[k] - effect.candidate->parameters[k].null);
      if (const double std_dev = fitted.interval_std_dev[first + k]; std_dev > 0)
        surest = std::max(surest, distance / std_dev);
    }
    first += effect.values.size();
    most = std::max(most, std::erfc(surest / std::numbers::sqrt2));
  }
  return most;
}

bool insignificant(double chance, std::size_t candidates) {
  return chance * static_cast<double>(candidates) >= rules::kFamilywiseLevel;
}

namespace {

/// True when each effect that `before` lacks changes some output by kLeastBeside of the largest change by
/// another effect.
bool distinct(const Fitted& fitted, const Fitted& before) {
  const auto is_distinct = [&](std::size_t i) {
    for (std::size_t output = 0; output < kOutputs; ++output) {
      double others = 0;
      for (std::size_t j = 0; j < fitted.change.size(); ++j)
        if (j != i) others = std::max(others, fitted.change[j][output]);
      const double own = fitted.change[i][output];
      if (own > 0 && own >= rules::kLeastBeside * others) return true;
    }
    return false;
  };
  if (fitted.effects.size() == 1) return true;
  for (std::size_t i = 0; i < fitted.effects.size(); ++i)
    if (!has(before.effects, fitted.effects[i].candidate) && !is_distinct(i)) return false;
  return true;
}

}  // namespace

bool accepted(const Fitted& fitted, const Fitted& before, std::size_t candidates) {
  const double least = before.effects.empty() ? rules::kLeastAlone.value : 0;
  return share_of_error(fitted, before) > least && distinct(fitted, before) &&
         !insignificant(block_test_p_value(fitted.deviance, before.deviance), candidates) &&
         !insignificant(likelihood_ratio_p_value(fitted, before), candidates);
}

bool likelier_in_resamples(const Fitted& fitted, const Fitted& base, std::uint64_t seed) {
  return block_wins(fitted.deviance, base.deviance, seed) > 1 - rules::kSignificant;
}

std::vector<Estimate> estimates(const Effects& effects, std::span<const double> std_dev) {
  std::vector<Estimate> all;
  std::size_t i = 0;
  for (const Effect& effect : effects)
    for (std::size_t k = 0; k < effect.values.size(); ++k, ++i)
      all.push_back(
          {effect.candidate->parameters[k].name,
           std::string{plant::unit_on(effect.candidate->axis, effect.candidate->parameters[k].unit)},
           effect.values[k], std_dev[i]});
  return all;
}

Ranked ranked_against(const Fitted& base, const Fitted& fitted) {
  Ranked ranked;
  ranked.label = label_of(fitted.effects);
  ranked.parameters = estimates(fitted.effects, fitted.block_std_dev);
  ranked.train_gain = sum(base.deviance) - sum(fitted.deviance);
  return ranked;
}

}  // namespace crane::diagnosis
