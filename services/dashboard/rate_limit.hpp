#pragma once
/// Limits the amount (tokens, bytes) per client within kRateWindow. No I/O; the time is an
/// argument.
#include <chrono>
#include <cstddef>
#include <deque>
#include <map>

#include "dashboard/connection_limits.hpp"

namespace crane::dashboard {

/// Delay of the answer to a wrong token.
inline constexpr std::chrono::milliseconds kGuessDelay{1000};
/// Largest number of wrong tokens of one client within kRateWindow. The page sends at most seven requests at
/// the same time.
inline constexpr std::size_t kMostGuesses = 8;
/// Bytes of histories within kRateWindow after which one client must wait: the histories of all topics, which
/// the page requests together. Building 8 MB takes about 10 ms.
inline constexpr std::size_t kMostHistory_bytes = 32U << 20U;
inline constexpr std::chrono::milliseconds kRateWindow{1000};

class RateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;
  explicit RateLimit(std::size_t most) : most_{most} {}

  /// @return true when the sum of count() of the client within kRateWindow is below the limit
  [[nodiscard]] bool permits(const Client& client, Time now);
  void count(const Client& client, Time now, std::size_t amount = 1);

 private:
  struct Done {
    std::size_t sum = 0;
    std::deque<std::pair<Time, std::size_t>> entries;
  };
  void forget_until(Time time);
  std::size_t most_;
  std::map<Client, Done> done_;
};

}  // namespace crane::dashboard
