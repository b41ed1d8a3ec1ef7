#pragma once
/// Where the zeros of the encoders are. An axis with Zero::homing is unknown until its mark has been seen
/// twice: once in the search, and again, after a way back, at the speed of the approach. What the counter
/// shows at the second time is set to the mark's position when the brake has closed, so that no position
/// jumps while a drive is on. Pure; it moves nothing and needs nobody: the supervisor drives the axis.
#include <array>
#include <cstdint>
#include <optional>

#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

/// One axis at one tick.
struct MarkView {
  std::int64_t counts = 0;  ///< unwrapped
  bool active = false;      ///< the mark's switch is closed by the axis
  bool asked = false;       ///< the command is to home this axis
  bool free = false;        ///< its brake is open, told and reported
  bool rests = false;       ///< its closed brake has stopped it
};

/// The mark's switch of an axis: a limit switch, or one of its own. @return false where nothing homes
[[nodiscard]] bool mark_active(const configuration::Drive& drive, const Inputs& inputs,
                               std::size_t axis) noexcept;

class Homing {
 public:
  explicit Homing(const configuration::Rig& rig);

  /// Once a tick and axis. @return counts to add to its counter, when its position becomes known
  std::optional<std::int64_t> step(std::size_t axis, const MarkView& view) noexcept;
  [[nodiscard]] bool known(std::size_t axis) const { return axes_[axis].known; }
  /// The second sight of the mark agreed with the first.
  [[nodiscard]] bool found(std::size_t axis) const { return axes_[axis].found.has_value(); }
  /// The counter is not to be trusted any more.
  void forget(std::size_t axis) noexcept;

 private:
  struct Axis {
    bool homes = false, known = true;
    double towards = 0;           ///< sign of the change of counts on the way to the mark
    double mark_counts = 0;       ///< what the counter has to show at the mark
    double approach_counts = 0;   ///< most counts a tick in the approach
    double agreement_counts = 0;  ///< that two sights may differ by
    double back_off_counts = 0;   ///< least way back between them
    bool was_active = false, was_asked = false;
    bool started = false;  ///< `last_counts` and `was_active` are of the tick before
    std::int64_t last_counts = 0;
    double farthest_counts = 0;  ///< way back from the first sight so far
    std::optional<double> first, found;
  };
  static void look(Axis& axis, const MarkView& view) noexcept;
  std::array<Axis, kDrives> axes_;
};

}  // namespace crane::bridge
