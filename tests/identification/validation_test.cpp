/// Compares the linear axis with the closed-form solution of its continuous loop.
#include "crane/identification/validation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace crane::identification {
namespace {

TEST(LinearResponse, TendsToTheCriticallyDampedStep) {
  // K_m (s, d) = (25, 10): poles -5 twice, x = r (1 - (1 + 5 t) e^(-5 t)); the effect of ticks and filters
  // tends to zero.
  const LinearLoop loop{.gain = 2, .stiffness_vpu = 12.5, .damping_vspu = 5, .period_s = 1e-4};
  const std::vector<double> reference(20'000, 0.7);
  const auto response = linear_response(loop, reference, 0.2);
  for (std::size_t k = 0; k < response.size(); k += 500) {
    const double t = static_cast<double>(k) * loop.period_s;
    EXPECT_NEAR(response[k], 0.2 + 0.5 * (1 - (1 + 5 * t) * std::exp(-5 * t)), 1e-3) << t;
  }
}

TEST(LinearResponse, ActsOneTickLate) {
  const LinearLoop loop{.gain = 2, .stiffness_vpu = 10, .damping_vspu = 0, .period_s = 0.01};
  const auto response = linear_response(loop, std::vector<double>{1, 1, 1}, 0);
  EXPECT_EQ(response[0], 0);
  EXPECT_EQ(response[1], 0);  // the first voltage acts from t_1 on
  EXPECT_DOUBLE_EQ(response[2], 0.5 * 2 * 10 * 1e-4);
}

TEST(Deviation, IsRmsAndPeakOfTheDifference) {
  const auto found = deviation(std::vector<double>{1, 2, 3, 4}, std::vector<double>{1, 2, 3, 2});
  EXPECT_DOUBLE_EQ(found.rms, 1);
  EXPECT_DOUBLE_EQ(found.peak, 2);
}

}  // namespace
}  // namespace crane::identification
