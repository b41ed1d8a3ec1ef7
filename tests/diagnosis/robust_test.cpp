#include "robust.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crane::diagnosis {
namespace {

TEST(Loss, IsQuadraticForNoiseAndLogarithmicForSlips) {
  EXPECT_NEAR(loss_of(0.3), 0.09, 0.001);
  EXPECT_LT(loss_of(100), 10 * 10);
  for (const double e : {-4.0, -0.5, 0.2, 3.0, 30.0})
    EXPECT_NEAR(weight_of(e) * e, (loss_of(e + 1e-5) - loss_of(e - 1e-5)) / 4e-5, 1e-6) << e;
}

}  // namespace
}  // namespace crane::diagnosis
