#pragma once
/// Events of a gamepad as a stick: which control acts on which axis, and when it acts. Time is an argument.
///
/// The codes are those of the Linux gamepad specification (docs.kernel.org/input/gamepad.html):
///   left stick, vertical    ABS_Y      trolley; pushed away from the operator: outwards
///   left stick, horizontal  ABS_X      slew; right: positive
///   right stick, vertical   ABS_RY     hoist; pulled towards the operator: down
///   left shoulder           BTN_TL     dead-man's button: the sticks act only while it is held
///   right shoulder          BTN_TR     micro-speed while held
///   lower action button     BTN_SOUTH  return to the stop point, while the dead-man's button is held
#include <array>
#include <cstdint>
#include <string>

namespace crane::cli {

struct GamepadEvent {
  std::uint16_t type = 0, code = 0;  ///< linux/input-event-codes.h
  int value = 0;
};

/// Range of one stick axis as the device states it, in counts.
struct StickRange {
  bool present = true;  ///< false: the device has no such axis
  int minimum = -32768, maximum = 32767;
  int flat = 0;   ///< dead zone that the driver states, from the centre to one side
  int value = 0;  ///< present value
};

/// Of trolley, slew and hoist.
using StickRanges = std::array<StickRange, 3>;

/// ABS code of trolley, slew and hoist.
[[nodiscard]] std::uint16_t stick_code(std::size_t axis);

/// @param selected  axes of the session; the others are not checked
/// @return which axis has no usable range, and why; empty: none
[[nodiscard]] std::string problem_of(const StickRanges& ranges, const std::array<bool, 3>& selected);

class GamepadLaw {
 public:
  /// Dead zone as a share of half the range, if the driver states none or a smaller one. Sticks of 16 bit
  /// come to rest within 4096 of 32768 counts, although their drivers state 128 (Android, key layout of the
  /// controller 0e6f:f501).
  static constexpr double kDeadZone = 0.125;
  /// A gamepad reports changes only: silence while the stick is deflected means a still hand or a broken
  /// radio link. As long as an operator at the keyboard may rest; judgement.
  static constexpr double kSilence_s = 10;

  /// @pre problem_of(ranges, selected) is empty
  GamepadLaw(const StickRanges& ranges, const std::array<bool, 3>& selected, bool micro = false);

  void take(const GamepadEvent& event, double now_s);

  /// True: deflection() acts. The dead-man's button was pressed after the start, is held, all sticks have
  /// been in their dead zones since, and the last event is at most kSilence_s old. After a silence, the
  /// button must be released and pressed again.
  [[nodiscard]] bool engaged(double now_s) const;
  /// Of the selected axes, without regard to engaged(). 0 in the dead zone, ±1 at the ends of the range.
  [[nodiscard]] std::array<double, 3> deflection() const;
  /// True: the dead-man's button is held, but a stick was deflected when it was pressed, and still is.
  [[nodiscard]] bool waits_for_centre() const { return held_ && !centred_; }
  /// True: the dead-man's button is held, whatever the sticks do.
  [[nodiscard]] bool held() const { return held_; }
  /// True once after a press of the button of the return while the dead-man's button is held.
  bool take_return();
  [[nodiscard]] bool returns() const { return returns_; }

 private:
  [[nodiscard]] bool silent(double now_s) const { return now_s - heard_s_ > kSilence_s; }
  void take_button(std::uint16_t code, int value);

  StickRanges ranges_;
  std::array<bool, 3> selected_;
  bool micro_;         ///< always
  bool slow_ = false;  ///< while the button is held
  bool held_ = false, centred_ = false, returns_ = false;
  double heard_s_ = 0;  ///< last event
};

}  // namespace crane::cli
