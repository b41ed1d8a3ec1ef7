#pragma once
/// The last samples of one signal, one per tick.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace crane::plant {

class SampleHistory {
 public:
  /// 0.5 s at 1 kHz. A longer delay is limited to this length.
  static constexpr std::size_t kLength = 512;
  static constexpr double kMostTicks = kLength - 2;

  /// Sets all samples to `value`.
  void fill(double value) { samples_.fill(value); }
  void push(double value) {
    newest_ = (newest_ + 1) % kLength;
    samples_[newest_] = value;
  }
  [[nodiscard]] double before(std::size_t ticks) const {
    return samples_[(newest_ + kLength - ticks) % kLength];
  }
  /// Value of the signal `ticks` ago, interpolated linearly. @pre ticks >= 0
  [[nodiscard]] double before(double ticks) const {
    const double most = std::min(ticks, kMostTicks), whole = std::floor(most), share = most - whole;
    const auto back = static_cast<std::size_t>(whole);
    return (1 - share) * before(back) + share * before(back + 1);
  }

 private:
  std::array<double, kLength> samples_{};
  std::size_t newest_ = 0;
};

}  // namespace crane::plant
