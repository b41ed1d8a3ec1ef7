#include "cli/tick_breakdown.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

namespace crane::cli {
namespace {

using bus::PathRecord;

std::size_t topic_index(const topics::Description& topic) { return bus::index_of(topic.name); }

/// A published sample and its process.
struct Published {
  std::size_t process = 0;
  const PathRecord* record = nullptr;
};

/// Records by topic and tick.
class Records {
 public:
  explicit Records(const std::vector<std::vector<PathRecord>>& records) {
    for (std::size_t i = 0; i < records.size(); ++i)
      for (const auto& record : records[i]) by_tick_[{record.topic, record.tick}] = {i, &record};
  }
  [[nodiscard]] std::optional<Published> find(std::size_t topic, std::uint64_t tick) const {
    const auto found = by_tick_.find({topic, tick});
    return found == by_tick_.end() ? std::nullopt : std::optional{found->second};
  }

 private:
  std::map<std::pair<std::uint64_t, std::uint64_t>, Published> by_tick_;
};

/// @return input of this tick that arrived last and ended the wait of the process; nothing: an input is
/// missing
std::optional<Published> last_input(const Records& records, const runtime::ComponentSpec& process,
                                    const PathRecord& output) {
  std::optional<Published> last;
  std::int64_t last_ns = 0;
  for (const auto& read : process.reads) {
    const auto topic = topic_index(*read.topic);
    const auto arrived_ns = output.arrived_ns[topic];
    if (!read.topic->every_tick || arrived_ns == 0) continue;  // 0: the controller does not need this input
    const auto input = records.find(topic, output.tick);
    if (!input) return std::nullopt;
    if (arrived_ns <= last_ns) continue;
    last = input;
    last_ns = arrived_ns;
  }
  return last;
}

/// Moves at most `part_ns` out of `rest_ns`. @return the moved time
std::int64_t take_from(std::int64_t& rest_ns, std::int64_t part_ns) {
  const auto taken_ns = std::clamp<std::int64_t>(part_ns, 0, std::max<std::int64_t>(rest_ns, 0));
  rest_ns -= taken_ns;
  return taken_ns;
}

void add_seal(Hop& hop, std::int64_t seal_ns, double codec_share) {
  const auto codec_ns = static_cast<std::int64_t>(static_cast<double>(seal_ns) * codec_share);
  hop.parts_ns[static_cast<std::size_t>(Part::codec)] += codec_ns;
  hop.parts_ns[static_cast<std::size_t>(Part::crc)] += seal_ns - codec_ns;
}

/// @param from      published sample
/// @param to        record of the process that received the sample
/// @param begin_ns  start of the hop: end of the previous hop
/// @param joins     true: `to` joined the sample; false: the hop ends with the arrival
/// @return nothing when the time stamps are not in order
std::optional<Hop> hop_between(const Published& from, const Published& to, std::int64_t begin_ns, bool joins,
                               const Isolated& isolated) {
  const auto& sent = *from.record;
  const auto& received = *to.record;
  const auto arrived_ns = received.arrived_ns[sent.topic];
  const auto end_ns = joins ? received.joined_ns : arrived_ns;
  if (arrived_ns < sent.sealed_ns || end_ns < arrived_ns || sent.published_ns < begin_ns) return std::nullopt;
  Hop hop{.from = from.process, .to = to.process};
  const auto part = [&hop](Part which) -> std::int64_t& {
    return hop.parts_ns[static_cast<std::size_t>(which)];
  };
  const double codec_share = isolated.codec_share[sent.topic];
  part(Part::law) = sent.published_ns - begin_ns;
  if (sent.joined_ns >
      begin_ns) {  // first hop only: it starts at the latch, before the sender reads the board
    part(Part::board) = std::min(sent.joined_ns, sent.published_ns) - begin_ns;
    part(Part::law) -= part(Part::board);
  }
  add_seal(hop, sent.sealed_ns - sent.published_ns, codec_share);
  auto delivery_ns = arrived_ns - sent.sealed_ns;
  part(Part::write) = take_from(delivery_ns, sent.written_ns - sent.sealed_ns);
  part(Part::kernel) = take_from(delivery_ns, isolated.udp_hop_ns);
  part(Part::vendor) = delivery_ns;
  if (!joins) return hop;
  auto reception_ns = end_ns - arrived_ns;
  part(Part::handover) = take_from(reception_ns, received.polled_ns - arrived_ns);
  part(Part::take) = take_from(reception_ns, received.taking_ns);
  add_seal(hop, take_from(reception_ns, received.checking_ns), codec_share);
  part(Part::join) = reception_ns;
  return hop;
}

/// The samples of the path of one tick, from the command back to the state.
std::optional<std::vector<Published>> samples_of(const std::vector<runtime::ComponentSpec>& processes,
                                                 const Records& records, std::uint64_t tick) {
  auto sample = records.find(topic_index(topics::command.description), tick);
  std::vector<Published> path;
  while (sample) {
    path.push_back(*sample);
    if (sample->process == 0) break;
    if (path.size() > processes.size()) return std::nullopt;
    sample = last_input(records, processes[sample->process], *sample->record);
  }
  if (!sample) return std::nullopt;
  std::ranges::reverse(path);
  return path;
}

std::optional<TickPath> path_of(const std::vector<runtime::ComponentSpec>& processes, const Records& records,
                                std::uint64_t tick, const Isolated& isolated) {
  auto samples = samples_of(processes, records, tick);
  const auto next_state = records.find(topic_index(topics::state.description), tick + 1);
  if (!samples || !next_state) return std::nullopt;
  samples->push_back(*next_state);
  TickPath path{.tick = tick, .latency_ns = 0, .hops = {}};
  const auto latched_ns = samples->front().record->sample_time_ns;
  auto begin_ns = latched_ns;
  for (std::size_t i = 0; i + 1 < samples->size(); ++i) {
    const auto& from = (*samples)[i];
    const auto& to = (*samples)[i + 1];
    const bool joins = i + 2 < samples->size();
    const auto hop = hop_between(from, to, begin_ns, joins, isolated);
    if (!hop) return std::nullopt;
    path.hops.push_back(*hop);
    begin_ns = joins ? to.record->joined_ns : to.record->arrived_ns[from.record->topic];
  }
  path.latency_ns = begin_ns - latched_ns;
  return path;
}

}  // namespace

TickBreakdown break_down(const std::vector<runtime::ComponentSpec>& processes,
                         const std::vector<std::vector<bus::PathRecord>>& records, const Isolated& isolated) {
  const Records all{records};
  const auto state = topic_index(topics::state.description);
  TickBreakdown breakdown;
  for (const auto& record : records.front()) {
    if (record.topic != state || &record == &records.front().back()) continue;
    if (auto path = path_of(processes, all, record.tick, isolated))
      breakdown.ticks.push_back(std::move(*path));
    else
      ++breakdown.left_out;
  }
  return breakdown;
}

PerPart sum_of_hops(const TickPath& path) {
  PerPart sum{};
  for (const auto& hop : path.hops)
    for (std::size_t i = 0; i < kParts; ++i) sum[i] += hop.parts_ns[i];
  return sum;
}

}  // namespace crane::cli
