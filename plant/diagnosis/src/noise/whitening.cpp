#include "noise/whitening.hpp"

#include "noise/filter.hpp"

namespace crane::diagnosis {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

Whitener::Whitener(const Disturbance& disturbance, const WindowMotion& motion)
    : step_(transition_of(disturbance, motion)) {
  PredictionCovariance prediction(disturbance, motion, 0);
  for (std::size_t k = 0; k < motion.profile.size(); ++k) {
    if (motion.profile[k].measured)
      rows_.push_back({prediction.gain(), 1 / std::sqrt(prediction.variance()), prediction.phase(k)});
    else
      rows_.push_back({Vector3d::Zero(), 0, prediction.phase(k)});
    prediction.advance(k);
  }
}

void Whitener::apply(Eigen::Ref<MatrixXd> x) const {
  for (Index column = 0; column < x.cols(); ++column) {
    Vector3d state = Vector3d::Zero();
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      double& value = x(static_cast<Index>(k), column);
      const Row& row = rows_[k];
      const double innovation = value - state[0];
      value = innovation * row.inverse_sd;
      state = next_state(step_, state + row.gain * innovation, row.phase);
    }
  }
}

}  // namespace crane::diagnosis
