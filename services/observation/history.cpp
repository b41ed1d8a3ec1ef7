#include "observation/history.hpp"

#include <algorithm>

namespace crane::observation {
namespace {

/// Memory of a sample in addition to its CDR bytes: struct, reference count, entry of the queue.
constexpr std::size_t kOverhead_bytes = sizeof(Sample) + 48;

std::size_t cost_of(const Sample& sample) { return sample.cdr.size() + kOverhead_bytes; }

}  // namespace

void History::add(SamplePtr sample) {
  auto& line = lines_[sample->topic];
  const auto oldest_ns = sample->log_time_ns - longest_ns_;
  line.bytes += cost_of(*sample);
  line.samples.push_back(std::move(sample));
  while (!line.samples.empty() &&
         (line.samples.front()->log_time_ns < oldest_ns || line.bytes > kLargestTopic_bytes)) {
    line.bytes -= cost_of(*line.samples.front());
    line.samples.pop_front();
  }
}

std::vector<SamplePtr> History::between(std::size_t topic, std::int64_t from_ns, std::int64_t to_ns) const {
  const auto& samples = lines_[topic].samples;
  const auto first =
      std::ranges::lower_bound(samples, from_ns, {}, [](const auto& s) { return s->log_time_ns; });
  const auto last =
      std::ranges::upper_bound(first, samples.end(), to_ns, {}, [](const auto& s) { return s->log_time_ns; });
  return {first, last};
}

std::size_t History::bytes() const {
  std::size_t sum = 0;
  for (const auto& line : lines_) sum += line.bytes;
  return sum;
}

}  // namespace crane::observation
