#pragma once
/// Clock of the bridge. The bridge stamps its samples with its monotonic clock, which has an arbitrary
/// origin. The supervisor measures silence with its own clock. No I/O.
#include <algorithm>
#include <cstdint>
#include <optional>

#include "crane/protection.hpp"
#include "crane/topics.hpp"

namespace crane::supervisor {

class BridgeClock {
 public:
  enum class Verdict : std::uint8_t {
    fits,         ///< the sample may be used
    contradicts,  ///< the time of the sample contradicts its tick: the sample must not be used
    begins_anew   ///< kAgreeing samples contradict the earlier ones and agree with each other: the bridge has
                  ///< been restarted
  };
  /// Number of samples: 1 s at 100 Hz, longer than the silence of 20 to 50 ms that stops an armed
  /// crane.
  static constexpr int kAgreeing = 100;

  explicit BridgeClock(std::int64_t period_ns) : period_ns_{period_ns} {}

  /// @return true when the sample may be used. The bridge latches tick k within the k-th period.
  ///   Therefore the deviations (Series) of all samples lie in an interval shorter than one period.
  ///   A wrong sample time would disable the checks of speeds and positions, and all time-outs.
  [[nodiscard]] bool fits(const msg::Header& header) const {
    return !accepted_ || continued(*accepted_, header) ||
           !protection::enabled(protection::Protection::supervisor_bridge_clock);
  }

  /// Call once for each sample, in the order of arrival.
  Verdict take(const msg::Header& header) {
    if (fits(header)) {
      accepted_ = accepted_ ? continued(*accepted_, header).value_or(Series{header}) : Series{header};
      agreeing_ = 0;
      return Verdict::fits;
    }
    const auto continuation = agreeing_ > 0 ? continued(rejected_, header) : std::nullopt;
    agreeing_ = continuation ? agreeing_ + 1 : 1;
    rejected_ = continuation.value_or(Series{header});
    if (agreeing_ < kAgreeing) return Verdict::contradicts;
    const Series series = rejected_;
    *this = BridgeClock{period_ns_};
    accepted_ = series;
    return Verdict::begins_anew;
  }

  /// @param now_ns  local time of arrival of the sample stamped `remote_ns`
  /// @return local time of `remote_ns`
  ///
  /// The offset is the smallest difference so far: that of the sample with the smallest delay. The offset
  /// grows by at most drift_ns() per call, so that the drift of the clocks does not make later samples appear
  /// late.
  [[nodiscard]] std::int64_t local_ns(std::int64_t remote_ns, std::int64_t now_ns) {
    const auto difference_ns = now_ns - remote_ns;
    offset_ns_ = offset_ns_ ? std::min(*offset_ns_ + drift_ns(), difference_ns) : difference_ns;
    return remote_ns + *offset_ns_;
  }

 private:
  /// 100 ppm of a period: twice the frequency error of the quartz of a computer.
  [[nodiscard]] std::int64_t drift_ns() const { return period_ns_ / 10'000; }

  /// Samples of one clock. Deviation: time minus tick times period, relative to the first sample.
  struct Series {
    explicit Series(const msg::Header& one) : first{one}, tick{one.tick} {}
    msg::Header first;
    std::uint64_t tick;                     ///< of the last sample
    double earliest_ns = 0, latest_ns = 0;  ///< smallest and largest deviation
  };
  /// @return the series with one more sample; nothing when the sample contradicts the series
  [[nodiscard]] std::optional<Series> continued(Series series, const msg::Header& next) const {
    std::int64_t elapsed_ns = 0;
    if (next.tick <= series.tick ||
        __builtin_sub_overflow(next.sample_time_ns, series.first.sample_time_ns, &elapsed_ns))
      return std::nullopt;
    const double nominal_ns =
        static_cast<double>(next.tick - series.first.tick) * static_cast<double>(period_ns_);
    const double deviation_ns = static_cast<double>(elapsed_ns) - nominal_ns;
    series.tick = next.tick;
    series.earliest_ns = std::min(series.earliest_ns, deviation_ns);
    series.latest_ns = std::max(series.latest_ns, deviation_ns);
    if (series.latest_ns - series.earliest_ns >= static_cast<double>(period_ns_)) return std::nullopt;
    return series;
  }

  std::int64_t period_ns_;
  std::optional<Series> accepted_;  ///< the samples that fit
  Series rejected_{msg::Header{}};  ///< the last samples that agree with each other and do not fit
  int agreeing_ = 0;                ///< number of samples in rejected_; 0: the last sample fits
  std::optional<std::int64_t> offset_ns_;
};

}  // namespace crane::supervisor
