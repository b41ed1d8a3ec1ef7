#include "study/fit.hpp"

#include <utility>

#include "study/block_std_dev.hpp"
#include "study/free_values.hpp"
#include "study/pattern_search.hpp"

namespace crane::diagnosis {
namespace {

/// kLeastGain for the values of a verdict, which are then within 0.1 standard deviations of the minimum.
constexpr double kLeastGainOfVerdict = 0.01;

}  // namespace

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
  along.keep_first(static_cast<std::size_t>(free_values_of(best.effects).values.size()));
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
