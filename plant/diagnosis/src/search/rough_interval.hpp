#pragma once
#include "study/study.hpp"

namespace crane::diagnosis {

/// Where the loss of a candidate is rough the least one is a matter of luck: any place may be it where the
/// bowl that the loss makes at large is not higher than the loss is rough. Widens `std_dev` of its values to
/// that.
void widen_rough(const Study& study, Fitted& fitted);

/// Every value moved by its number of `step`, within its bounds.
[[nodiscard]] Effects moved(Effects effects, const Eigen::VectorXd& step);

}  // namespace crane::diagnosis
