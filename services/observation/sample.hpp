#pragma once
/// One sample of the bus as CDR bytes, as recordings store it.
#include <cstdint>
#include <memory>
#include <vector>

#include "crane/bus/cdr.hpp"

namespace crane::observation {

struct Sample {
  std::size_t topic = 0;  ///< index in topics::kAll
  msg::Header header{};
  std::int64_t source_time_ns = 0;   ///< clock of the writer, ns since 1970
  std::int64_t arrival_time_ns = 0;  ///< monotonic clock of this process
  std::int64_t written_time_ns = 0;  ///< source_time_ns on the monotonic clock of this process
  std::int64_t log_time_ns = 0;      ///< arrival, ns since 1970; a change of the system clock causes no jump
  std::vector<std::uint8_t> cdr;     ///< plain CDR with its 4-byte encapsulation header
};
/// A crane/supervisor or crane/state older than this is stale: both topics are published every
/// tick.
inline constexpr std::int64_t kStale_ns = 1'000'000'000;

/// Shared by history and clients; never changes after construction.
using SamplePtr = std::shared_ptr<const Sample>;

[[nodiscard]] inline const topics::Description& topic_of(const Sample& sample) {
  return topics::kAll[sample.topic];
}

/// @return true when `sample` belongs to `topic` and was decoded to `out`, with printable texts
template <class T>
[[nodiscard]] bool decode(const topics::Topic<T>& topic, const Sample& sample, T& out) {
  if (topic_of(sample).name != topic.description.name || sample.cdr.size() < bus::kEncapsulation_bytes)
    return false;
  const auto& codec = bus::CdrCodec::of(*topic.description.descriptor);
  if (!codec.decode(std::span{sample.cdr}.subspan(bus::kEncapsulation_bytes), false, &out)) return false;
  codec.make_texts_printable(&out);  // a recording may come from any program
  return true;
}

}  // namespace crane::observation
