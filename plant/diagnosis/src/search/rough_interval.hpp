#pragma once
#include "study/whitened_data.hpp"

namespace crane::diagnosis {

/// Parabola through the loss around a fit, along the values of each effect with a rough loss: a gap, and
/// every effect on a drive that sticks and slips.
struct LossParabola {
  Eigen::VectorXd std_dev;  ///< of all values of the fit; 0 for a value with a smooth loss
  Effects best;             ///< least loss of all evaluated values, those of the fit included
  double best_loss = 0;
};

/// Standard deviation of values with a rough loss. The position of the minimum of a rough loss is random:
/// every value at which the parabola rises by less than the roughness is equally likely. The values of the
/// other effects are held. @param base  evaluation of the base model
[[nodiscard]] LossParabola fit_loss_parabola(const WhitenedData& data, const Evaluation& base,
                                             const Fitted& fitted);

}  // namespace crane::diagnosis
