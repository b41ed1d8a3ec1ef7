#include "dashboard/send_queue.hpp"

#include <gtest/gtest.h>

namespace crane::dashboard {
namespace {

Outgoing message(Keep keep, std::size_t bytes, std::uint32_t channel = 1) {
  return {.channel = channel,
          .keep = keep,
          .binary = true,
          .head = "",
          .payload = std::make_shared<const std::vector<std::uint8_t>>(bytes)};
}

TEST(SendQueue, OfASlowClientDropsSamplesAndCountsThem) {
  SendQueue queue;
  constexpr std::size_t kSample_bytes = 300;
  for (int i = 0; i < 100'000; ++i) ASSERT_TRUE(queue.put(message(Keep::may_drop, kSample_bytes)));
  EXPECT_LE(queue.bytes(), SendQueue::kDropAbove_bytes);
  EXPECT_EQ(queue.dropped(), 100'000 - queue.bytes() / kSample_bytes);
}

TEST(SendQueue, KeepsEventsWhileSamplesAreDropped) {
  SendQueue queue;
  for (int i = 0; i < 10'000; ++i) ASSERT_TRUE(queue.put(message(Keep::may_drop, 300)));
  ASSERT_TRUE(queue.put(message(Keep::always, 200, 7)));
  bool found = false;
  while (!queue.empty()) found = queue.take().channel == 7 || found;
  EXPECT_TRUE(found);
}

TEST(SendQueue, HoldsOnlyTheNewestVersionOfADocument) {
  SendQueue queue;
  for (std::size_t i = 1; i <= 1000; ++i) {
    ASSERT_TRUE(queue.put(message(Keep::newest, i, 1)));
    ASSERT_TRUE(queue.put(message(Keep::newest, 2 * i, 2)));
  }
  EXPECT_EQ(queue.bytes(), 3000U);
  EXPECT_EQ(queue.take().payload->size(), 1000U);
  EXPECT_EQ(queue.take().payload->size(), 2000U);
  EXPECT_TRUE(queue.empty());
}

TEST(SendQueue, DisconnectsAClientThatDoesNotReadEvents) {
  SendQueue queue;
  std::size_t put = 0;
  while (queue.put(message(Keep::always, 1000))) ASSERT_LT(++put, 10'000U);
  EXPECT_LE(queue.bytes(), SendQueue::kGiveUpAbove_bytes + 1000);
}

TEST(SendQueue, CountsItsBytesExactly) {
  SendQueue queue;
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(queue.put(message(i % 2 ? Keep::newest : Keep::always, static_cast<std::size_t>(i))));
  while (!queue.empty()) (void)queue.take();
  EXPECT_EQ(queue.bytes(), 0U);
}

}  // namespace
}  // namespace crane::dashboard
