#include "dashboard/operator_seat.hpp"

#include <gtest/gtest.h>

namespace crane::dashboard {
namespace {

constexpr std::int64_t kHeld_ns = OperatorSeat::kHeldFor_ns;

TEST(OperatorSeat, OneHoldsItAndTheOthersWatch) {
  OperatorSeat seat;
  EXPECT_FALSE(seat.holder(0));
  EXPECT_TRUE(seat.take("Ada", "key of Ada", 0));
  EXPECT_FALSE(seat.take("Bob", "key of Bob", 1));
  EXPECT_EQ(seat.holder(1), "Ada");
  EXPECT_TRUE(seat.renew("key of Ada", 1));
  EXPECT_FALSE(seat.renew("key of Bob", 1));
  EXPECT_FALSE(seat.renew("", 1));
}

TEST(OperatorSeat, IsFreeAgainWhenItsHolderIsSilent) {
  OperatorSeat seat;
  ASSERT_TRUE(seat.take("Ada", "key of Ada", 0));
  EXPECT_TRUE(seat.renew("key of Ada", kHeld_ns - 1));
  EXPECT_TRUE(seat.holder(2 * kHeld_ns - 1));
  EXPECT_FALSE(seat.holder(2 * kHeld_ns));
  EXPECT_FALSE(seat.renew("key of Ada", 2 * kHeld_ns));
  EXPECT_TRUE(seat.take("Bob", "key of Bob", 2 * kHeld_ns));
  EXPECT_FALSE(seat.renew("key of Ada", 2 * kHeld_ns));
}

TEST(OperatorSeat, IsReleasedByItsHolderOnly) {
  OperatorSeat seat;
  ASSERT_TRUE(seat.take("Ada", "key of Ada", 0));
  EXPECT_FALSE(seat.release("key of Bob", 1));
  EXPECT_TRUE(seat.release("key of Ada", 1));
  EXPECT_FALSE(seat.holder(1));
  EXPECT_FALSE(seat.renew("", 1));
}

TEST(OperatorSeat, KeepsNamesShort) {
  OperatorSeat seat;
  ASSERT_TRUE(seat.take(std::string(1000, 'x'), "key", 0));
  EXPECT_EQ(seat.holder(0)->size(), OperatorSeat::kLongestName);
}

}  // namespace
}  // namespace crane::dashboard
