#pragma once
/// Electrical model of the brakes: watchdog relay and delays of the coils. Time is an argument [ns].
#include <cstdint>
#include <limits>

namespace crane::simulator {

inline constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

/// Charge-pump relay, see simulated_board.hpp.
class WatchdogRelay {
 public:
  WatchdogRelay(std::int64_t timeout_ns, std::int64_t permit_ns)
      : timeout_ns_(timeout_ns), permit_ns_(permit_ns) {}

  void set_level(bool level, std::int64_t now_ns) {
    if (level == level_) return;
    level_ = level;
    if (!toggled_ || now_ns - last_toggle_ns_ > timeout_ns_) toggling_since_ns_ = now_ns;
    toggled_ = true;
    last_toggle_ns_ = now_ns;
    if (now_ns - toggling_since_ns_ >= permit_ns_) closed_ = true;
  }
  /// Time at which the relay opens if the level does not change; kNever_ns when it is open.
  [[nodiscard]] std::int64_t drops_at_ns() const {
    return closed_ ? last_toggle_ns_ + timeout_ns_ + 1 : kNever_ns;
  }
  void let_time_pass(std::int64_t now_ns) {
    if (now_ns >= drops_at_ns()) closed_ = false;
  }
  void drop() {
    closed_ = false;
    toggled_ = false;
  }
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  std::int64_t timeout_ns_, permit_ns_;
  std::int64_t last_toggle_ns_ = 0, toggling_since_ns_ = 0;
  bool level_ = false, toggled_ = false, closed_ = false;
};

/// One brake coil: the brake follows its supply after the opening or closing time.
class BrakeCoil {
 public:
  BrakeCoil(std::int64_t close_ns, std::int64_t open_ns) : close_ns_(close_ns), open_ns_(open_ns) {}

  void set_supply(bool supplied, std::int64_t now_ns) {
    if (supplied == supplied_) return;
    supplied_ = supplied;
    const bool already_there = closed_ != supplied;
    changes_at_ns_ = already_there ? kNever_ns : now_ns + (supplied ? open_ns_ : close_ns_);
    let_time_pass(now_ns);
  }
  [[nodiscard]] std::int64_t changes_at_ns() const { return changes_at_ns_; }
  void let_time_pass(std::int64_t now_ns) {
    if (now_ns < changes_at_ns_) return;
    closed_ = !supplied_;
    changes_at_ns_ = kNever_ns;
  }
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  std::int64_t close_ns_, open_ns_;
  std::int64_t changes_at_ns_ = kNever_ns;
  bool supplied_ = false, closed_ = true;
};

}  // namespace crane::simulator
