#include "cli/scope_input.hpp"

#include <algorithm>
#include <iostream>

#include "cli/sample_json.hpp"

namespace crane::cli {
namespace {

struct Reader {
  std::size_t topic = 0;  ///< index in FieldTable::topics()
  bus::CdrSubscriber subscriber;
};

std::vector<Reader> readers_of(bus::Bus& bus, const observation::FieldTable& table,
                               const observation::TickRows& rows) {
  std::vector<Reader> readers;
  for (const auto topic : rows.topics())
    readers.push_back({topic, bus.cdr_subscriber(*find_topic(table.topics()[topic].name))});
  return readers;
}

}  // namespace

void feed_live(bus::Bus& bus, const observation::FieldTable& table, observation::TickRows& rows,
               double timeout_s, const std::function<bool()>& finished) {
  auto readers = readers_of(bus, table, rows);
  std::vector<std::uint8_t> cdr;
  bus::SampleInfo info;
  bool heard = false, hinted = false;
  const auto begin_ns = runtime::monotonic_ns();
  wait_until(bus, timeout_s, [&] {
    for (auto& reader : readers)
      while (!finished() && reader.subscriber.take(cdr, &info)) {
        if (!info.valid) continue;
        heard = true;
        rows.add(reader.topic, cdr);
      }
    constexpr std::int64_t kHintAfter_ns = 3'000'000'000;
    if (!heard && !hinted && runtime::monotonic_ns() - begin_ns > kHintAfter_ns) {
      hinted = true;
      std::cerr << "waiting: no sample received yet" << where_and_remedy(bus) << '\n';
    }
    return finished();
  });
  if (!heard && !finished()) throw std::runtime_error("no sample received" + where_and_remedy(bus));
}

void feed_recording(recording::McapReader& recording, const observation::FieldTable& table,
                    observation::TickRows& rows, const std::function<bool()>& finished) {
  recording::Selection selection;
  for (const auto topic : rows.topics()) selection.topics.push_back(table.topics()[topic].name);
  recording.for_each(selection, [&](const recording::Message& message) {
    const auto place = std::ranges::find(selection.topics, message.channel->topic) - selection.topics.begin();
    rows.add(rows.topics()[static_cast<std::size_t>(place)], message.data);
    return !finished();
  });
  for (const auto& problem : recording.problems()) std::cerr << problem << '\n';
}

}  // namespace crane::cli
