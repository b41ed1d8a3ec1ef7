#include "study/joint_fit.hpp"

#include <algorithm>
#include <utility>

#include "study/block_std_dev.hpp"

namespace crane::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;

namespace {

/// Appends the slopes of the base model along the inaccuracies `beside`, in the parts in which the simulation
/// with the effects is like that of the base model. @param along  of the effects
void append_base_slopes(const WhitenedData& data, const BaseSlopes& base, const Fitted& fitted,
                        const Effects& beside, Slopes& along) {
  std::size_t own = 0;
  for (const Effect& effect : fitted.effects) own += effect.values.size();
  if (along.size() != own || base.of_values.empty()) return;
  std::size_t first = 0;
  for (const Effect& present : data.nuisance().inaccuracies) {
    const bool fitted_beside = std::ranges::any_of(
        beside, [&](const Effect& inaccuracy) { return inaccuracy.candidate == present.candidate; });
    for (std::size_t i = first; fitted_beside && i < first + present.values.size(); ++i)
      along.push_back(base.of_values[i]);
    first += present.values.size();
  }
  along.forget(own, along.size(), unlike(data.body(), fitted.effects, fitted.train, base.simulation));
}

}  // namespace

void fit_jointly(const WhitenedData& data, const BaseSlopes& base, Fitted& fitted, Slopes& along) {
  fitted.nuisance = data.nuisance();
  const Effects beside = visible_beside(data.nuisance().inaccuracies, fitted.effects);
  if (beside.empty()) return;
  Fitted joint;
  joint.effects = fitted.effects;
  joint.effects.insert(joint.effects.end(), beside.begin(), beside.end());
  joint.train = fitted.train;
  append_base_slopes(data, base, fitted, beside, along);
  descend(data, joint, {.inaccuracies = beside.size()}, along);
  const auto first = joint.effects.begin() + static_cast<std::ptrdiff_t>(fitted.effects.size());
  for (auto inaccuracy = first; inaccuracy != joint.effects.end(); ++inaccuracy)
    for (Effect& present : fitted.nuisance.inaccuracies)
      if (present.candidate == inaccuracy->candidate) present.values = inaccuracy->values;
  fitted.effects.assign(joint.effects.begin(), first);
  fitted.train = std::move(joint.train);
  if (fitted.effects.empty()) return;
  along = data.plain_slopes(joint.effects, fitted.train, std::move(along));
  set_block_std_dev(data, data.whitened(along, fitted.train), {first, joint.effects.end()}, fitted);
}

}  // namespace crane::diagnosis
