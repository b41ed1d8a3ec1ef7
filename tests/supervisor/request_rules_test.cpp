#include "process/request_rules.hpp"

#include <gmock/gmock.h>

namespace crane::supervisor {
namespace {

/// "1.310000 must lie in [0.19, 1.310000]" would not name the difference.
TEST(RequestRules, NameATargetAndItsLimitsWithAllDigits) {
  Limits limits;
  limits.axis[0] = {.present = true};
  limits.axis[0].low_limit = 0.19;
  limits.axis[0].high_limit = 1.31;
  limits.axis[0].soft_margin = 0;
  msg::Request request{};
  request.id = 1;
  request.kind = crane_REQUEST_MOVE;
  request.selected[0] = true;
  request.target[0] = 1.31000001;
  EXPECT_THAT(problem_of(request, limits),
              testing::HasSubstr("trolley target 1.31000001 must lie in [0.19, 1.31]"));
}

}  // namespace
}  // namespace crane::supervisor
