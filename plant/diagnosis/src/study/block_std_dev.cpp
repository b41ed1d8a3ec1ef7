#include "study/block_std_dev.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace crane::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;

void set_block_std_dev(const WhitenedData& data, const Slopes& along, const Effects& inaccuracies,
                       Fitted& fitted) {
  const BlockScores both = data.scores(fitted.train, along);
  Index own = 0;
  for (const Effect& effect : fitted.effects) own += static_cast<Index>(effect.values.size());
  fitted.left_out = left_out(leading(both, own));
  for (double& block : fitted.left_out) block /= kLossPerDeviance;
  // An inaccuracy at its bound is not a free value.
  std::vector<Index> free(static_cast<std::size_t>(own));
  std::iota(free.begin(), free.end(), 0);
  Index next = own;
  for (const Effect& inaccuracy : inaccuracies)
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
