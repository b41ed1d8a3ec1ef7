#include "noise/whitening.hpp"

#include "noise/filter.hpp"

namespace crane::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

Whitener::Whitener(const Disturbance& disturbance, const Passage& passage)
    : step_(step_of(disturbance, passage)) {
  Prediction prediction(disturbance, passage, 0);
  for (std::size_t k = 0; k < passage.paces.size(); ++k) {
    if (passage.paces[k].seen)
      rows_.push_back({prediction.gain(), 1 / std::sqrt(prediction.variance()), prediction.going(k)});
    else
      rows_.push_back({Vector3d::Zero(), 0, prediction.going(k)});
    prediction.advance(k);
  }
}

void Whitener::apply(Eigen::Ref<MatrixXd> x) const {
  for (Index column = 0; column < x.cols(); ++column) {
    Vector3d state = Vector3d::Zero();
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      double& value = x(static_cast<Index>(k), column);
      const Row& row = rows_[k];
      const double surprise = value - state[0];
      value = surprise * row.inverse_sd;
      state = advanced(step_, state + row.gain * surprise, row.going);
    }
  }
}

}  // namespace crane::diagnosis
