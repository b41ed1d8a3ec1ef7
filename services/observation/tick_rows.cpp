#include "observation/tick_rows.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "crane/topics.hpp"

namespace crane::observation {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TickRows::TickRows(const FieldTable& table, std::vector<Field> columns, Visit visit)
    : table_{table}, columns_{std::move(columns)}, visit_{std::move(visit)} {
  const auto& known = table.topics();
  const auto state = std::ranges::find(known, topics::state.description.name, &TopicFields::name);
  if (state == known.end())
    throw std::invalid_argument("there is no crane/state, whose ticks are the time base of the rows");
  state_ = static_cast<std::size_t>(state - known.begin());
  topics_.push_back(state_);
  for (const auto& column : columns_)
    if (std::ranges::find(topics_, column.topic) == topics_.end()) topics_.push_back(column.topic);
  std::size_t most_values = 0;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const auto& topic = known[topics_[i]];
    if (topic.every_tick) required_ |= std::uint64_t{1} << i;
    most_values = std::max(most_values, topic.reader.size());
  }
  decoded_.resize(most_values);
  newest_values_.assign(columns_.size(), kMissing);
}

TickRows::Waiting& TickRows::waiting(std::uint64_t tick) {
  const auto [found, is_new] = waiting_.try_emplace(tick);
  if (is_new) {
    found->second.row.tick = tick;
    found->second.row.values.assign(columns_.size(), kMissing);
  }
  return found->second;
}

void TickRows::add(std::size_t topic, std::span<const std::uint8_t> payload) {
  const auto place = std::ranges::find(topics_, topic);
  if (place == topics_.end()) return;
  const auto& fields = table_.topics()[topic];
  fields.reader.read(payload, decoded_);
  const auto fill = [&](std::vector<double>& values) {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i].topic == topic) values[i] = decoded_[columns_[i].leaf];
  };
  if (!fields.every_tick) return fill(newest_values_);

  const auto tick = static_cast<std::uint64_t>(decoded_[fields.tick_leaf]);
  if (begun_ && tick <= newest_) {
    if (topic != state_ || newest_ - tick <= kMostWaiting) {
      ++late_;
      return;
    }
    waiting_.clear();  // the clock master has restarted, and its ticks begin at 0 again
    begun_ = false;
  }
  Waiting& at = waiting(tick);
  const auto bit = std::uint64_t{1} << (place - topics_.begin());
  if ((at.arrived & bit) != 0) return;  // a second sample of one tick
  at.arrived |= bit;
  fill(at.row.values);
  if (topic == state_) at.row.time_ns = static_cast<std::int64_t>(decoded_[fields.time_leaf]);
  const bool complete = (at.arrived & required_) == required_;
  while (!waiting_.empty() &&
         ((complete && waiting_.begin()->first <= tick) || waiting_.size() > kMostWaiting))
    emit_first();
}

void TickRows::finish() {
  while (!waiting_.empty()) emit_first();
}

void TickRows::emit_first() {
  auto first = waiting_.extract(waiting_.begin()).mapped();
  newest_ = first.row.tick;
  begun_ = true;
  constexpr std::uint64_t kState = 1;  // crane/state is the first of topics_
  if ((first.arrived & kState) == 0) return;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (!table_.topics()[columns_[i].topic].every_tick) first.row.values[i] = newest_values_[i];
  visit_(first.row);
}

}  // namespace crane::observation
