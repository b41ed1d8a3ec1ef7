#pragma once
/// Detects a limit cycle: an oscillation of an axis about its rest whose speed does not decay.
#include <algorithm>
#include <array>
#include <cmath>

namespace crane::control::adaptation {

class LimitCycle {
 public:
  LimitCycle(double zero_band, double period_s) : least_{kLeastBands * zero_band}, period_s_{period_s} {}
  void reset() noexcept { *this = LimitCycle{least_ / kLeastBands, period_s_}; }

  /// @return true when the oscillation has lasted for kReversals reversals; the count then starts again
  /// @param noise  standard deviation of raw_speed
  bool step(double raw_speed, double noise) noexcept {
    const double least = std::max(least_, kNoise * noise);
    const double speed = mean_ = smooth(raw_speed);
    since_reversal_s_ += period_s_;
    if (since_reversal_s_ > kLongest_s) reversals_ = 0;
    if (std::abs(speed) <= least) return false;
    const int side = speed > 0 ? 1 : -1;
    if (side == side_) {
      peak_ = std::max(peak_, std::abs(speed));
      travel_ += std::abs(speed) * period_s_;
      return false;
    }
    const bool sustained = peak_ >= kKept * last_peak_ && travel_ <= kLongestTravel;
    if (!sustained || reversals_ == 0) first_peak_ = peak_;
    reversals_ = sustained ? reversals_ + 1 : 0;
    last_peak_ = peak_;
    side_ = side;
    peak_ = std::abs(speed);
    travel_ = since_reversal_s_ = 0;
    if (reversals_ < kReversals) return false;
    reversals_ = 0;
    return last_peak_ >= kKeptInAll * first_peak_;
  }
  /// Mean speed over the last kMean ticks.
  [[nodiscard]] double mean_speed() const noexcept { return mean_; }

 private:
  static constexpr double kLeastBands = 0.4;     // largest speed at rest / zero band
  static constexpr double kNoise = 1;            // largest speed at rest / standard deviation of raw_speed
  static constexpr int kReversals = 8;           // a damped swing of the support decays within three
  static constexpr double kKept = 0.6;           // smallest ratio of successive peak speeds
  static constexpr double kKeptInAll = 0.5;      // smallest ratio of the last to the first peak speed
  static constexpr double kLongestTravel = 0.1;  // longest travel of a half period, m or rad
  static constexpr double kLongest_s = 3;        // longest time between two reversals
  static constexpr std::size_t kMean = 4;        // ticks of the mean speed: reduces the noise of the encoder

  double smooth(double speed) noexcept {
    last_[next_] = speed;
    next_ = (next_ + 1) % kMean;
    double sum = 0;
    for (const double value : last_) sum += value;
    return sum / kMean;
  }

  double least_, period_s_, mean_ = 0;
  std::array<double, kMean> last_{};
  std::size_t next_ = 0;
  int side_ = 0, reversals_ = 0;
  double peak_ = 0, last_peak_ = 0, first_peak_ = 0, travel_ = 0, since_reversal_s_ = 0;
};

}  // namespace crane::control::adaptation
