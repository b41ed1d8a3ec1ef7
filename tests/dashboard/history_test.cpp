#include "dashboard/history.hpp"

#include <gtest/gtest.h>

#include "samples.hpp"

namespace crane::dashboard {
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

TEST(History, IsPackedWithTimeLengthAndBytes) {
  const auto sample = sample_of(topics::event, msg::Event{}, 0x0102030405060708);
  const auto bytes = packed({sample, sample});
  ASSERT_EQ(bytes.size(), 2 * (12 + sample->cdr.size()));
  EXPECT_EQ(bytes.substr(0, 8), "\x08\x07\x06\x05\x04\x03\x02\x01");
  EXPECT_EQ(static_cast<unsigned char>(bytes[8]), sample->cdr.size() & 0xFFU);
}

}  // namespace
}  // namespace crane::dashboard
