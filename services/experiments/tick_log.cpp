#include "experiments/tick_log.hpp"

#include "crane/bus/cdr.hpp"

namespace crane::experiments {
namespace {

std::size_t index_of(const topics::Description& topic) {
  for (std::size_t i = 0; i < topics::kAll.size(); ++i)
    if (topics::kAll[i].name == topic.name) return i;
  return topics::kAll.size();
}

}  // namespace

TickLog::TickLog(const std::optional<std::filesystem::path>& recording) {
  if (!recording) return;
  writer_.emplace(*recording);
  channels_ = recording::add_topic_channels(*writer_);
}

template <class T>
void TickLog::write(const topics::Topic<T>& topic, const T& sample, std::int64_t time_ns,
                    std::uint64_t tick) {
  constexpr std::array<std::uint8_t, 4> kPlainCdrLittleEndian{0, 1, 0, 0};
  const auto& codec = bus::CdrCodec::of(*topic.description.descriptor);
  bytes_.assign(kPlainCdrLittleEndian.begin(), kPlainCdrLittleEndian.end());
  bytes_.resize(kPlainCdrLittleEndian.size() + codec.max_encoded_bytes());
  const auto size = codec.encode(&sample, std::span{bytes_}.subspan(kPlainCdrLittleEndian.size()));
  writer_->message(channels_[index_of(topic.description)], static_cast<std::uint32_t>(tick), time_ns, time_ns,
                   std::span{bytes_}.first(kPlainCdrLittleEndian.size() + size));
}

void TickLog::add(const Tick& tick, std::span<const OtherSample> others) {
  const auto number = tick.state->header.tick;
  const auto time_ns = tick.state->header.sample_time_ns;
  if (number > 0 && period_ns_ == 0) period_ns_ = time_ns - last_time_ns_;
  last_time_ns_ = time_ns;
  rows_.add(*tick.state);
  rows_.add(*tick.reference);
  rows_.add(*tick.demand);
  rows_.add(*tick.supervisor);
  if (!writer_) return;
  write(topics::state, *tick.state, time_ns, number);
  write(topics::reference, *tick.reference, time_ns, number);
  write(topics::tracking, *tick.tracking, time_ns, number);
  write(topics::anti_swing, *tick.anti_swing, time_ns, number);
  write(topics::demand, *tick.demand, time_ns, number);
  write(topics::command, *tick.command, time_ns, number);
  write(topics::supervisor, *tick.supervisor, time_ns, number);
  for (const auto& other : others)
    writer_->message(channels_[index_of(*other.topic)], static_cast<std::uint32_t>(number), time_ns, time_ns,
                     other.cdr);
}

void TickLog::close() {
  if (writer_) writer_->close();
}

recording::Table TickLog::table(std::uint64_t zero_tick) const {
  auto table = rows_.table(static_cast<std::int64_t>(zero_tick) * period_ns_);
  const auto* time_s = table.find("time_s");
  if (time_s == nullptr) return table;
  const auto first = static_cast<std::ptrdiff_t>(
      std::find_if(time_s->begin(), time_s->end(), [](double t) { return t >= 0; }) - time_s->begin());
  for (auto& column : table.columns)
    column.values.erase(column.values.begin(), column.values.begin() + first);
  return table;
}

}  // namespace crane::experiments
