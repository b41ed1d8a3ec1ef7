#pragma once
/// A signal's recent past, sampled once per tick, read back at any delay in ticks.
#include <algorithm>
#include <cstddef>
#include <vector>

namespace crane::control {

class DelayLine {
 public:
  /// Memory for delays up to `longest_ticks`, >= 0; allocated here and never again.
  explicit DelayLine(double longest_ticks)
      : longest_ticks_(longest_ticks), samples_(static_cast<std::size_t>(longest_ticks) + 2) {}

  /// The past becomes constant.
  void reset(double value) noexcept { std::fill(samples_.begin(), samples_.end(), value); }

  void push(double sample) noexcept {
    newest_ = (newest_ + 1) % samples_.size();
    samples_[newest_] = sample;
  }

  /// Linear between samples; 0 is the newest one. Delays outside [0, longest_ticks] read its end, NaN the
  /// newest.
  [[nodiscard]] double at(double delay_ticks) const noexcept {
    const double delay = std::max(0.0, std::min(delay_ticks, longest_ticks_));
    const auto whole = static_cast<std::size_t>(delay);
    const double fraction = delay - static_cast<double>(whole);
    return (1 - fraction) * sample(whole) + fraction * sample(whole + 1);
  }

 private:
  [[nodiscard]] double sample(std::size_t ticks_ago) const noexcept {
    return samples_[(newest_ + samples_.size() - ticks_ago) % samples_.size()];
  }

  double longest_ticks_;
  std::vector<double> samples_;
  std::size_t newest_ = 0;
};

}  // namespace crane::control
