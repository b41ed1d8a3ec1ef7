// The shares of the connections and the guesses of the token, without sockets.
#include <gtest/gtest.h>

#include <random>

#include "dashboard/connection_limits.hpp"
#include "dashboard/rate_limit.hpp"

namespace crane::dashboard {
namespace {

using namespace std::chrono_literals;

TEST(ConnectionLimits, NeitherSideKeepsOutTheOther) {
  ConnectionLimits limits;
  const Client far{.foreign = true, .name = "192.0.2.7"}, near{.foreign = false, .name = "user 0"};
  for (std::size_t i = 0; i < kMostOfOneSide; ++i) {
    ASSERT_TRUE(limits.has_place(far, Kind::connection));
    limits.add(far, Kind::connection);
  }
  EXPECT_FALSE(limits.has_place(far, Kind::connection));
  EXPECT_TRUE(limits.has_place(near, Kind::connection));
  EXPECT_FALSE(limits.must_yield(far, near, Kind::connection));
  limits.remove(far, Kind::connection);
  EXPECT_TRUE(limits.has_place(far, Kind::connection));
}

/// Random clients connect and disconnect. One of them never has more than its share and loses nothing.
TEST(ConnectionLimits, AClientWithinItsShareNeverYields) {
  constexpr unsigned kSeed = 7;
  std::mt19937 random{kSeed};
  for (const std::size_t clients : {2U, 3U, 5U, 16U, 48U}) {
    ConnectionLimits limits;
    const auto client = [](std::size_t i) { return Client{.foreign = true, .name = std::to_string(i)}; };
    const auto share = kMostOfOneSide / clients;
    std::size_t yields = 0;
    for (int step = 0; step < 20'000; ++step) {
      const auto who = random() % clients;
      const auto& comer = client(who);
      if (who == 0 && limits.open(comer, Kind::connection) == share) {
        limits.remove(comer, Kind::connection);
      } else if (limits.has_place(comer, Kind::connection)) {
        limits.add(comer, Kind::connection);
      } else {
        std::size_t most = 0;
        for (std::size_t i = 0; i < clients; ++i)
          if (limits.open(client(i), Kind::connection) > limits.open(client(most), Kind::connection))
            most = i;
        const bool yields_place = limits.must_yield(client(most), comer, Kind::connection);
        ASSERT_TRUE(yields_place || limits.open(comer, Kind::connection) >= share) << "seed " << kSeed;
        if (!yields_place) continue;
        ASSERT_GT(limits.open(client(most), Kind::connection), share) << "seed " << kSeed;
        limits.remove(client(most), Kind::connection);
        limits.add(comer, Kind::connection);
        ++yields;
      }
    }
    if (clients > 2) {
      EXPECT_GT(yields, 0U) << clients;
    }
  }
}

TEST(RateLimit, CountsWhatEachClientHasDoneWithinASecond) {
  RateLimit limit{kMostGuesses};
  const Client guesser{.foreign = true, .name = "192.0.2.7"}, other{.foreign = true, .name = "192.0.2.8"};
  const RateLimit::Time begin{};
  for (std::size_t i = 0; i < kMostGuesses; ++i) {
    EXPECT_TRUE(limit.permits(guesser, begin));
    limit.count(guesser, begin + i * 1ms);
  }
  EXPECT_FALSE(limit.permits(guesser, begin + 8ms));
  EXPECT_TRUE(limit.permits(other, begin + 8ms));
  EXPECT_FALSE(limit.permits(guesser, begin + kGuessDelay - 1ms));
  EXPECT_TRUE(limit.permits(guesser, begin + kGuessDelay));
  limit.count(guesser, begin + kGuessDelay);
  EXPECT_FALSE(limit.permits(guesser, begin + kGuessDelay)) << "one of eight places is free";
  limit.count(other, begin, kMostGuesses);
  EXPECT_FALSE(limit.permits(other, begin)) << "one entry counts by its amount";
}

}  // namespace
}  // namespace crane::dashboard
