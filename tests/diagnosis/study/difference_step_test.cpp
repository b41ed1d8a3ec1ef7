#include <gtest/gtest.h>

#include <cmath>

#include "study/study.hpp"

namespace crane::diagnosis {
namespace {

/// The step of a heavy load's pivot friction is nearly as large as the range of the parameter.
TEST(DifferenceStep, StaysWithinTheBounds) {
  FreeParameter p;
  p.low = 0, p.high = 100;
  for (const double step : {1.0, 94.0, 500.0}) {
    p.step = step;
    for (const double value : {0.0, 5.0, 15.0, 50.0, 85.0, 99.9, 100.0}) {
      const double moved = difference_step(p, value);
      EXPECT_GT(std::abs(moved), 0) << "step " << step << " at " << value;
      EXPECT_GE(value + moved, p.low) << "step " << step << " at " << value;
      EXPECT_LE(value + moved, p.high) << "step " << step << " at " << value;
    }
  }
}

}  // namespace
}  // namespace crane::diagnosis
