#pragma once
/// Converts times of another host's clock to local time. The bridge stamps its samples with its monotonic
/// clock, which has an arbitrary origin; the supervisor measures silence with its own clock.
#include <algorithm>
#include <cstdint>
#include <optional>

namespace crane::supervisor {

class ClockOffset {
 public:
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
  std::optional<std::int64_t> offset_ns_;
};

}  // namespace crane::supervisor
