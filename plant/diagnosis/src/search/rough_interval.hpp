#pragma once
#include "study/study.hpp"

namespace crane::diagnosis {

/// Where the loss of a candidate is rough the least one is a matter of luck: any place may be it where the
/// bowl that the loss makes at large is not higher than the loss is rough. Widens `std_dev` of its values to
/// that.
void widen_rough(const Study& study, Fitted& fitted);

}  // namespace crane::diagnosis
