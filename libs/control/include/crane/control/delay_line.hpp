#pragma once
/// Stores the last samples of a signal, one per tick, and returns the signal delayed by any number of ticks.
#include <algorithm>
#include <cstddef>
#include <vector>

namespace crane::control {

class DelayLine {
 public:
  /// @param longest_ticks  largest delay, >= 0. The constructor allocates all memory.
  explicit DelayLine(double longest_ticks)
      : longest_ticks_(longest_ticks), samples_(static_cast<std::size_t>(longest_ticks) + 2) {}

  /// Sets all stored samples to `value`.
  void reset(double value) noexcept { std::fill(samples_.begin(), samples_.end(), value); }

  void push(double sample) noexcept {
    newest_ = (newest_ + 1) % samples_.size();
    samples_[newest_] = sample;
  }

  /// @param delay_ticks  0: the newest sample; limited to [0, longest_ticks]; NaN counts as 0
  /// @return value of the signal, interpolated linearly between samples
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
