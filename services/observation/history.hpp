#pragma once
/// The newest samples of every topic, bounded by age and by bytes.
#include <array>
#include <deque>

#include "observation/sample.hpp"

namespace crane::observation {

class History {
 public:
  static constexpr std::int64_t kLongest_ns = 120'000'000'000;
  /// Largest number of bytes per topic. 120 s at 100 Hz need 6 MB for crane/state and 40 MB for all topics.
  static constexpr std::size_t kLargestTopic_bytes = 8U << 20U;

  explicit History(std::int64_t longest_ns = kLongest_ns) : longest_ns_{longest_ns} {}

  void add(SamplePtr sample);
  /// Samples of a topic that arrived in [from_ns, to_ns] (Sample::log_time_ns), oldest first.
  [[nodiscard]] std::vector<SamplePtr> between(std::size_t topic, std::int64_t from_ns,
                                               std::int64_t to_ns) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Line {
    std::deque<SamplePtr> samples;
    std::size_t bytes = 0;
  };
  std::int64_t longest_ns_;
  std::array<Line, topics::kAll.size()> lines_;
};

}  // namespace crane::observation
