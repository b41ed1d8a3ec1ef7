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

/// The rows of a column depend on each other, the columns do not: several columns at once take hardly longer
/// than one.
template <int kColumns>
void Whitener::apply_to(Eigen::Ref<MatrixXd> x, Index first) const {
  using Values = Eigen::Array<double, kColumns, 1>;
  Values position = Values::Zero(), speed = Values::Zero(), acceleration = Values::Zero();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    auto values = x.template block<1, kColumns>(static_cast<Index>(k), first);
    const Values innovation = values.transpose().array() - position;
    values = (innovation * row.inverse_sd).matrix().transpose();
    const Values p = position + row.gain[0] * innovation, a = acceleration + row.gain[2] * innovation;
    Values v = speed + row.gain[1] * innovation;
    if (row.phase != MotionPhase::moving) v.setZero();
    position = step_(0, 0) * p + step_(0, 1) * v + step_(0, 2) * a;
    speed = step_(1, 0) * p + step_(1, 1) * v + step_(1, 2) * a;
    acceleration = step_(2, 2) * a;
  }
}

void Whitener::apply(Eigen::Ref<MatrixXd> x) const {
  constexpr int kTogether = 4;
  Index column = 0;
  for (; column + kTogether <= x.cols(); column += kTogether) apply_to<kTogether>(x, column);
  for (; column < x.cols(); ++column) apply_to<1>(x, column);
}

}  // namespace crane::diagnosis
