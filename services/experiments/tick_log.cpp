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

void TickLog::describe(const recording::Metadata& run, std::string_view rig_text) {
  if (!writer_) return;
  writer_->metadata("crane", run);
  writer_->attachment("rig.toml", "application/toml", 0,
                      {reinterpret_cast<const std::uint8_t*>(rig_text.data()), rig_text.size()});
}

std::vector<std::uint8_t> TickLog::encoded(const topics::Description& topic, const void* sample) {
  constexpr std::array<std::uint8_t, bus::kEncapsulation_bytes> kPlainCdrLittleEndian{0, 1, 0, 0};
  const auto& codec = bus::CdrCodec::of(*topic.descriptor);
  std::vector<std::uint8_t> cdr(kPlainCdrLittleEndian.begin(), kPlainCdrLittleEndian.end());
  cdr.resize(kPlainCdrLittleEndian.size() + codec.max_encoded_bytes());
  cdr.resize(kPlainCdrLittleEndian.size() +
             codec.encode(sample, std::span{cdr}.subspan(kPlainCdrLittleEndian.size())));
  return cdr;
}

void TickLog::write(const topics::Description& topic, std::span<const std::uint8_t> cdr, std::int64_t time_ns,
                    std::uint64_t tick) {
  writer_->message(channels_[index_of(topic)], static_cast<std::uint32_t>(tick), time_ns, time_ns, cdr);
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
  for (const auto& input : inputs_) write(*input.topic, input.cdr, time_ns, number);
  inputs_.clear();
  const auto store = [&](const auto& topic, const auto& sample) {
    write(topic.description, encoded(topic.description, &sample), time_ns, number);
  };
  store(topics::state, *tick.state);
  store(topics::reference, *tick.reference);
  store(topics::tracking, *tick.tracking);
  store(topics::anti_swing, *tick.anti_swing);
  store(topics::demand, *tick.demand);
  store(topics::command, *tick.command);
  store(topics::supervisor, *tick.supervisor);
  for (const auto& other : others) write(*other.topic, other.cdr, time_ns, number);
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
