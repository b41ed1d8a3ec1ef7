#include "observation/acquisition.hpp"

#include <algorithm>
#include <cmath>

namespace crane::observation {

std::optional<Capture> Acquisition::add(const Row& row, double condition) {
  ++rows_;
  if (!ring_.empty() && row.time_ns <= ring_.back().time_ns) {  // the clock master has restarted
    ring_.clear();
    trigger_tick_.reset();
    armed_ns_.reset();
  }
  if (!armed_ns_) armed_ns_ = row.time_ns;
  ring_.push_back(row);
  const bool risen = condition == 1 && condition_ == 0.0;
  if (!std::isnan(condition)) condition_ = condition;
  if (risen && !trigger_tick_) {
    trigger_tick_ = row.tick;
    trigger_ns_ = row.time_ns;
  }
  drop_old(row.time_ns);
  const bool over =
      trigger_tick_ ? row.time_ns - trigger_ns_ >= window_.after_ns
                    : window_.automatic && row.time_ns - *armed_ns_ >= window_.before_ns + window_.after_ns;
  if (!over) return std::nullopt;
  return take(true);
}

std::optional<Capture> Acquisition::finish() {
  if (!trigger_tick_) return std::nullopt;
  return take(false);
}

void Acquisition::drop_old(std::int64_t now_ns) {
  const auto oldest_ns = trigger_tick_       ? trigger_ns_ - window_.before_ns
                         : window_.automatic ? now_ns - window_.before_ns - window_.after_ns
                                             : now_ns - window_.before_ns;
  while (ring_.front().time_ns < oldest_ns || ring_.size() > kMostRows) ring_.pop_front();
}

/// The rows remain in the ring, because the next capture may begin before the end of this capture.
Capture Acquisition::take(bool complete) {
  Capture capture{.rows = {ring_.begin(), ring_.end()}, .trigger = std::nullopt, .complete = complete};
  if (trigger_tick_) {
    const auto found = std::ranges::find(capture.rows, *trigger_tick_, &Row::tick);
    if (found != capture.rows.end()) capture.trigger = static_cast<std::size_t>(found - capture.rows.begin());
  }
  trigger_tick_.reset();
  armed_ns_ = ring_.back().time_ns;
  return capture;
}

}  // namespace crane::observation
