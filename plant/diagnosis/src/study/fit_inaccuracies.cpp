/// Joint fit of effects and inaccuracies of the rig file; covariance and penalty of a fit.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "study/blocks.hpp"

namespace crane::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;

void Study::append_base_slopes(const Fitted& fitted, const Effects& beside, Slopes& along) const {
  std::size_t own = 0;
  for (const Effect& effect : fitted.effects) own += effect.values.size();
  const ShowsIn unlike = unlike_base(fitted.effects, fitted.train);
  if (along.drive.size() != own || slopes_of_inaccuracies_.empty() || unlike.drive || unlike.load) return;
  std::size_t first = 0;
  for (const Effect& present : inaccuracies_) {
    const bool fitted_beside = std::ranges::any_of(
        beside, [&](const Effect& inaccuracy) { return inaccuracy.candidate == present.candidate; });
    for (std::size_t i = first; fitted_beside && i < first + present.values.size(); ++i)
      along.push_back(slopes_of_inaccuracies_[i]);
    first += present.values.size();
  }
}

void Study::fit_inaccuracies(Fitted& fitted, Slopes& along) {
  const Effects beside =
      fitted.effects.empty() ? inaccuracies_beside({}) : visible_inaccuracies_beside(fitted.effects);
  if (beside.empty()) return;
  Fitted joint;
  joint.effects = fitted.effects;
  joint.effects.insert(joint.effects.end(), beside.begin(), beside.end());
  joint.train = fitted.train;
  append_base_slopes(fitted, beside, along);
  descend(joint, Loss::robust, std::numeric_limits<double>::infinity(), along, 0);
  const auto first = joint.effects.begin() + static_cast<std::ptrdiff_t>(fitted.effects.size());
  for (auto inaccuracy = first; inaccuracy != joint.effects.end(); ++inaccuracy)
    for (Effect& present : inaccuracies_)
      if (present.candidate == inaccuracy->candidate) present.values = inaccuracy->values;
  fitted.effects.assign(joint.effects.begin(), first);
  fitted.train = std::move(joint.train);
  if (fitted.effects.empty()) return;
  along = plain_slopes(joint.effects, fitted.train, std::move(along));
  estimate_uncertainty(fitted, whitened(along, fitted.train), {first, joint.effects.end()});
}

void Study::estimate_uncertainty(Fitted& fitted, const Slopes& along, const Effects& beside) const {
  const BlockScores both = block_scores(fitted.train, along);
  Index own = 0;
  for (const Effect& effect : fitted.effects) own += static_cast<Index>(effect.values.size());
  fitted.left_out = left_out(leading(both, own));
  for (double& block : fitted.left_out) block /= kLossPerDeviance;
  // An inaccuracy at its bound is not a free value.
  std::vector<Index> free(static_cast<std::size_t>(own));
  std::iota(free.begin(), free.end(), 0);
  Index next = own;
  for (const Effect& inaccuracy : beside)
    for (std::size_t k = 0; k < inaccuracy.values.size(); ++k, ++next) {
      const FreeParameter& p = inaccuracy.candidate->parameters[k];
      if (inaccuracy.values[k] > p.low && inaccuracy.values[k] < p.high) free.push_back(next);
    }
  const MatrixXd scores = both.by_block(Eigen::all, free);
  const MatrixXd inverse =
      MatrixXd(both.curvature(free, free)).completeOrthogonalDecomposition().pseudoInverse();
  const MatrixXd covariance = inverse * (scores.transpose() * scores) * inverse;
  fitted.block_std_dev.clear();
  for (const double variance : covariance.diagonal().head(own))
    fitted.block_std_dev.push_back(std::sqrt(std::max(0.0, variance)));
  fitted.parameters = fitted.block_std_dev.size();
}

}  // namespace crane::diagnosis
