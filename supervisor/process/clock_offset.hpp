#pragma once
/// Times of another host's clock in local time. The bridge stamps its samples with its own monotonic clock,
/// which may have begun at any time; the supervisor judges silence by its own.
#include <algorithm>
#include <cstdint>
#include <optional>

namespace crane::supervisor {

class ClockOffset {
 public:
  /// Local time of `remote_ns`. @param now_ns  local time at which a sample stamped `remote_ns` is here
  ///
  /// The offset is the smallest difference seen: that of the sample that travelled fastest. It may grow by
  /// kDrift_ns a call, so that clocks that run apart do not make every later sample look late.
  [[nodiscard]] std::int64_t local_ns(std::int64_t remote_ns, std::int64_t now_ns) {
    const auto difference_ns = now_ns - remote_ns;
    offset_ns_ = offset_ns_ ? std::min(*offset_ns_ + kDrift_ns, difference_ns) : difference_ns;
    return remote_ns + *offset_ns_;
  }

 private:
  /// 100 ppm of a period of 10 ms: twice what the quartz of a computer is off by.
  static constexpr std::int64_t kDrift_ns = 1000;
  std::optional<std::int64_t> offset_ns_;
};

}  // namespace crane::supervisor
