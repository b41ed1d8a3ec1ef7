#pragma once
/// Headers of the newest ticks. Tick numbers begin at 0 after each start; in real time, sample times do not
/// repeat. A sample with tick and sample time of a recent tick therefore belongs to this run.
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "crane/topics.hpp"

namespace crane::runtime {

class RecentTicks {
 public:
  /// @param kept_s    shortest time for which a tick is stored, > 0
  /// @param period_s  duration of a tick, > 0
  RecentTicks(double kept_s, double period_s)
      : ring_(static_cast<std::size_t>(std::ceil(kept_s / period_s)) + 1) {}

  /// @param now_ns  local time of this tick
  void add(const msg::Header& header, std::int64_t now_ns) {
    ring_[header.tick % ring_.size()] = {header.tick, header.sample_time_ns, now_ns};
  }
  /// @return local time of the tick with this number and sample time; nothing when there is no such recent
  /// tick
  [[nodiscard]] std::optional<std::int64_t> time_of(const msg::Header& header) const {
    const auto& known = ring_[header.tick % ring_.size()];
    if (!known || known->tick != header.tick || known->sample_time_ns != header.sample_time_ns)
      return std::nullopt;
    return known->now_ns;
  }

 private:
  struct LocalTick {
    std::uint64_t tick;
    std::int64_t sample_time_ns, now_ns;
  };
  std::vector<std::optional<LocalTick>> ring_;
};

}  // namespace crane::runtime
