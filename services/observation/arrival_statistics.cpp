#include "observation/arrival_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace crane::observation {

std::optional<double> percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  const auto rank = std::ceil(share * static_cast<double>(values.size()));
  const auto index = std::clamp<std::size_t>(static_cast<std::size_t>(rank), 1, values.size()) - 1;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(index);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

std::optional<Spread> spread(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return Spread{*percentile(values, 0.5), *percentile(values, 0.99),
                *std::max_element(values.begin(), values.end())};
}

bool Joining::over(std::int64_t source_time_ns, std::int64_t arrival_time_ns) {
  if (over_) return true;
  if (!first_) first_ = {source_time_ns, arrival_time_ns};
  if (last_)
    over_ = arrival_time_ns - last_->arrival_ns >= (source_time_ns - last_->source_ns) / 2 ||
            source_time_ns - first_->source_ns > kLongest_ns;
  last_ = {source_time_ns, arrival_time_ns};
  return over_;
}

void ArrivalStatistics::add(const Arrival& arrival) {
  ++counts_.samples;
  ++window_samples_;
  if (newest_ && arrival.epoch != newest_->epoch) {
    ++counts_.restarts;
    counts_.lost += missing_.size();
    missing_.clear();
    newest_.reset();
    joining_ = {};
    window_first_.reset();
    window_intervals_ = 0;
  }
  const bool in_order = !newest_ || (counts_ticks_ ? arrival.tick > newest_->tick
                                                   : arrival.source_time_ns >= newest_->source_time_ns);
  if (counts_ticks_) count(arrival);
  if (!in_order) return;
  const bool joined = joining_.over(arrival.source_time_ns, arrival.arrival_time_ns);
  if (newest_) {
    const auto stretched_ns = (arrival.arrival_time_ns - newest_->arrival_time_ns) -
                              (arrival.source_time_ns - newest_->source_time_ns);
    if (joined) jitter_us_.push_back(std::abs(static_cast<double>(stretched_ns)) * 1e-3);
    window_intervals_ += window_first_ ? 1 : 0;
  }
  newest_ = arrival;
  if (!window_first_) window_first_ = arrival;
  window_last_ = arrival;
}

void ArrivalStatistics::count(const Arrival& arrival) {
  if (!newest_) return;
  if (arrival.tick > newest_->tick)
    skip(newest_->tick + 1, arrival.tick);
  else if (missing_.erase(arrival.tick) == 0)
    ++counts_.duplicate;
  else {
    ++counts_.late;
    if (window_first_ && arrival.tick > window_first_->tick) ++window_intervals_;
  }
}

void ArrivalStatistics::skip(std::uint64_t from, std::uint64_t to) {
  // A late sample of an older tick is not recognised: its tick counts as lost.
  constexpr std::uint64_t kRemembered = 10'000;
  const auto remembered_from = to - from > kRemembered ? to - kRemembered : from;
  counts_.lost += remembered_from - from;
  for (auto tick = remembered_from; tick < to; ++tick) missing_.insert(missing_.end(), tick);
  for (; missing_.size() > kRemembered; missing_.erase(missing_.begin())) ++counts_.lost;
}

ArrivalStatistics::Counts ArrivalStatistics::counts() const {
  auto result = counts_;
  result.lost += missing_.size();
  return result;
}

ArrivalStatistics::Window ArrivalStatistics::take_window() {
  Window window{.samples = window_samples_, .rate_hz = std::nullopt, .jitter_us = spread(jitter_us_)};
  if (window_first_ && window_last_ && window_intervals_ > 0) {
    const auto span_ns = window_last_->source_time_ns - window_first_->source_time_ns;
    if (span_ns > 0)
      window.rate_hz = static_cast<double>(window_intervals_) * 1e9 / static_cast<double>(span_ns);
  }
  window_first_ = window_last_;  // the next window begins at the end of this one
  window_intervals_ = window_samples_ = 0;
  jitter_us_.clear();
  return window;
}

}  // namespace crane::observation
