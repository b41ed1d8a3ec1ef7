#include "observation/history.hpp"

#include <gtest/gtest.h>

#include "samples.hpp"

namespace crane::observation {
namespace {

TEST(History, KeepsTwoMinutes) {
  History history;
  for (int second = 0; second <= 300; ++second)
    history.add(sample_of(topics::state, msg::State{}, second * kSecond_ns));
  const auto all = history.between(0, 0, 1000 * kSecond_ns);
  ASSERT_EQ(all.size(), 121U);
  EXPECT_EQ(all.front()->log_time_ns, 180 * kSecond_ns);
  EXPECT_EQ(history.between(0, 200 * kSecond_ns, 202 * kSecond_ns).size(), 3U);
  EXPECT_TRUE(history.between(0, 301 * kSecond_ns, 400 * kSecond_ns).empty());
  EXPECT_TRUE(history.between(0, 250 * kSecond_ns, 240 * kSecond_ns).empty());
}

TEST(History, OfAFastTopicIsBoundedByBytes) {
  History history;
  for (int i = 0; i < 100'000; ++i)
    history.add(sample_of(topics::state, msg::State{}, std::int64_t{i} * 100'000));
  EXPECT_LE(history.bytes(), History::kLargestTopic_bytes);
  EXPECT_GT(history.bytes(), History::kLargestTopic_bytes / 2);
}

}  // namespace
}  // namespace crane::observation
