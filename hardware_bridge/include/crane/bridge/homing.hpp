#pragma once
/// Determines the zeros of the encoders during homing. The position of an axis with Zero::homing is unknown
/// until its mark has been detected twice: first in the search, then at the approach speed after the axis has
/// backed off. The second detection determines the position. The counter is set after the brake has closed,
/// so that no position jumps while a drive is active. The supervisor moves the axis, and requests
/// homing until the counter is set. If the request ends earlier (homing failed or was stopped), the
/// position stays unknown. No I/O and no clock.
#include <array>
#include <cstdint>
#include <optional>

#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

/// One axis at one tick.
struct MarkView {
  std::int64_t counts = 0;  ///< unwrapped counts
  bool active = false;      ///< true: the homing mark is active
  bool requested = false;   ///< true: crane/command homes this axis, and the bridge has not latched
  bool free = false;        ///< true: the brake is commanded open and reports open
  bool rests = false;       ///< true: the closed brake has brought the axis to rest
};

/// State of the switch of an axis' homing mark: a limit switch or a separate switch. @return false for an
/// axis without homing
[[nodiscard]] bool mark_active(const configuration::Drive& drive, const Inputs& inputs,
                               std::size_t axis) noexcept;

class Homing {
 public:
  explicit Homing(const configuration::Rig& rig);

  /// Call once per tick and axis. @return counts to add to the counter, at the tick at which the position
  ///   becomes known; nothing at every other tick
  std::optional<std::int64_t> step(std::size_t axis, const MarkView& view) noexcept;
  /// True when the position of the axis is known.
  [[nodiscard]] bool known(std::size_t axis) const { return axes_[axis].known; }
  /// True when the second detection of the mark agrees with the first.
  [[nodiscard]] bool found(std::size_t axis) const { return axes_[axis].found.has_value(); }
  /// Makes the position unknown, because the counter is no longer valid.
  void forget(std::size_t axis) noexcept;

 private:
  struct Axis {
    bool homes = false, known = true;
    double towards = 0;           ///< sign of the change of counts on the way to the mark
    double mark_counts = 0;       ///< counts at the position of the mark
    double approach_counts = 0;   ///< largest change of counts per tick in the approach
    double agreement_counts = 0;  ///< largest difference between the two detections
    double back_off_counts = 0;   ///< smallest distance that the axis must back off between the detections
    bool was_active = false, was_requested = false;
    bool started = false;  ///< true: `last_counts` and `was_active` are those of the previous tick
    std::int64_t last_counts = 0;
    double farthest_counts = 0;  ///< distance that the axis has backed off from the first detection
    std::optional<double> first, found;
  };
  static void look(Axis& axis, const MarkView& view) noexcept;
  std::array<Axis, kDrives> axes_;
};

}  // namespace crane::bridge
