#include "study/joint_fit.hpp"

#include <algorithm>
#include <utility>

#include "study/block_std_dev.hpp"

namespace crane::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// If the slopes along the inaccuracies `beside` are unknown: takes those of the base model, in the parts in
/// which the simulation with the effects is like that of the base model.
void take_base_slopes(const WhitenedData& data, const BaseSlopes& base, const Fitted& fitted,
                      const Effects& beside, FitSlopes& along) {
  std::size_t own = 0;
  for (const Effect& effect : fitted.effects) own += effect.values.size();
  Slopes& slopes = along.of_values;
  if (slopes.size() > own) return;
  along.inaccuracies_at = simulation_of(fitted.train);
  if (slopes.size() < own || base.of_values.empty()) return;
  std::size_t first = 0;
  for (const Effect& present : data.nuisance().inaccuracies) {
    const bool fitted_beside = std::ranges::any_of(
        beside, [&](const Effect& inaccuracy) { return inaccuracy.candidate == present.candidate; });
    for (std::size_t i = first; fitted_beside && i < first + present.values.size(); ++i)
      slopes.push_back(base.of_values[i]);
    first += present.values.size();
  }
  const ShowsIn other = unlike(data.body(), fitted.effects, fitted.train, base.simulation);
  slopes.forget(own, slopes.size(), other);
  if (!other.drive) along.inaccuracies_at.drive = base.simulation.drive;
  if (!other.load) along.inaccuracies_at.load = base.simulation.load;
}

}  // namespace

void fit_jointly(const WhitenedData& data, const BaseSlopes& base, Fitted& fitted, FitSlopes& along) {
  fitted.nuisance = data.nuisance();
  const Effects beside = visible_beside(data.nuisance().inaccuracies, fitted.effects);
  if (beside.empty()) return;
  Fitted joint;
  joint.effects = fitted.effects;
  joint.effects.insert(joint.effects.end(), beside.begin(), beside.end());
  joint.train = fitted.train;
  take_base_slopes(data, base, fitted, beside, along);
  descend(data, joint, {.inaccuracies = beside.size()}, along);
  const auto first = joint.effects.begin() + static_cast<std::ptrdiff_t>(fitted.effects.size());
  for (auto inaccuracy = first; inaccuracy != joint.effects.end(); ++inaccuracy)
    for (Effect& present : fitted.nuisance.inaccuracies)
      if (present.candidate == inaccuracy->candidate) present.values = inaccuracy->values;
  fitted.effects.assign(joint.effects.begin(), first);
  fitted.train = std::move(joint.train);
  if (fitted.effects.empty()) return;
  along.of_values = data.plain_slopes(joint.effects, fitted.train, std::move(along.of_values));
  set_block_std_dev(data, data.whitened(along.of_values, fitted.train), {first, joint.effects.end()}, fitted);
}

}  // namespace crane::diagnosis
