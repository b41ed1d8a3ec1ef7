#pragma once
#include "study/study.hpp"

namespace crane::diagnosis {

/// The loss about a fit, as it is at large along the values of each effect whose loss is rough: a gap's, and
/// all that acts on a drive that may stick and slip.
struct RoughBowl {
  Eigen::VectorXd std_dev;  ///< of all values of the fit; 0 of those whose loss is not rough
  Effects best;             ///< of all places that were tried, the fit's own among them
  double best_loss = 0;
};

/// Where a loss is rough the least one is a matter of luck: any place may be it where the bowl that the loss
/// makes at large is not higher than the loss is rough. The other effects' values stay.
[[nodiscard]] RoughBowl rough_bowl(const Study& study, const Fitted& fitted);

}  // namespace crane::diagnosis
