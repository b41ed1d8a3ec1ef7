#pragma once
/// Clock of the bridge. The bridge stamps its samples with its monotonic clock, which has an arbitrary
/// origin; the supervisor measures silence with its own clock. Pure.
#include <algorithm>
#include <cmath>
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
    begins_anew   ///< kAgreeing samples contradict the earlier ones and agree with each other: as after a
                  ///< restart of the bridge
  };
  /// Longer than the time in which missing samples stop an armed crane.
  static constexpr int kAgreeing = 100;

  explicit BridgeClock(std::int64_t period_ns) : period_ns_{period_ns} {}

  /// @return true when the sample may be used. The bridge latches tick k within the k-th period: the
  /// difference of two sample times deviates by less than one period from the difference of the ticks times
  /// the period. A wrong time would disable the checks of speeds and positions, and all time-outs.
  [[nodiscard]] bool fits(const msg::Header& header) const {
    return !last_ || agree(*last_, header) ||
           !protection::enabled(protection::Protection::supervisor_bridge_clock);
  }

  /// Call once for each sample, in the order of arrival.
  Verdict take(const msg::Header& header) {
    if (fits(header)) {
      last_ = header;
      agreeing_ = 0;
      return Verdict::fits;
    }
    agreeing_ = agreeing_ > 0 && agree(rejected_, header) ? agreeing_ + 1 : 1;
    rejected_ = header;
    if (agreeing_ < kAgreeing) return Verdict::contradicts;
    *this = BridgeClock{period_ns_};
    last_ = header;
    return Verdict::begins_anew;
  }

  /// @return local time of `remote_ns`. @param now_ns  local time at which the sample stamped `remote_ns`
  /// arrived
  ///
  /// The offset is the smallest difference so far: that of the sample with the smallest delay. The offset
  /// grows by at most kDrift_ns per call, so that the drift of the clocks does not make later samples appear
  /// late.
  [[nodiscard]] std::int64_t local_ns(std::int64_t remote_ns, std::int64_t now_ns) {
    const auto difference_ns = now_ns - remote_ns;
    offset_ns_ = offset_ns_ ? std::min(*offset_ns_ + kDrift_ns, difference_ns) : difference_ns;
    return remote_ns + *offset_ns_;
  }

 private:
  /// 100 ppm of a period of 10 ms: twice the frequency error of the quartz of a computer.
  static constexpr std::int64_t kDrift_ns = 1000;

  [[nodiscard]] bool agree(const msg::Header& earlier, const msg::Header& later) const {
    std::int64_t elapsed_ns = 0;
    if (later.tick <= earlier.tick ||
        __builtin_sub_overflow(later.sample_time_ns, earlier.sample_time_ns, &elapsed_ns))
      return false;
    const double nominal_ns =
        static_cast<double>(later.tick - earlier.tick) * static_cast<double>(period_ns_);
    return std::abs(static_cast<double>(elapsed_ns) - nominal_ns) < static_cast<double>(period_ns_);
  }

  std::int64_t period_ns_;
  std::optional<msg::Header> last_;  ///< last sample that fits
  msg::Header rejected_{};           ///< last sample that does not fit
  int agreeing_ = 0;  ///< samples up to rejected_ that agree with each other; 0: the last sample fits
  std::optional<std::int64_t> offset_ns_;
};

}  // namespace crane::supervisor
