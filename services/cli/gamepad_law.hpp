#pragma once
/// Law of the gamepad: maps its events to deflections of the stick. Time is an argument.
///
/// The codes are those of the Linux gamepad specification (docs.kernel.org/input/gamepad.html):
///   left lever, vertical    ABS_Y      trolley; pushed away from the operator: outwards
///   left lever, horizontal  ABS_X      slew; right: positive
///   right lever, vertical   ABS_RY     hoist; pulled towards the operator: down
///   left shoulder           BTN_TL     dead-man's button: the levers act only while it is held
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

/// Range and value of one stick axis as the device reports them, in counts.
struct StickRange {
  bool present = true;  ///< false: the device has no such axis
  int minimum = -32768, maximum = 32767;
  int flat = 0;   ///< dead zone that the driver reports, from the centre to one side
  int value = 0;  ///< present value
};

/// Sticks of trolley, slew and hoist.
using StickRanges = std::array<StickRange, 3>;

/// ABS code of trolley, slew and hoist.
[[nodiscard]] std::uint16_t stick_code(std::size_t axis);

/// @param selected  axes of the session; the others are not checked
/// @return first axis without a usable range, and the reason; empty when all ranges are usable
[[nodiscard]] std::string problem_of(const StickRanges& ranges, const std::array<bool, 3>& selected);

class GamepadLaw {
 public:
  /// Smallest dead zone, as a share of half the range; a larger dead zone of the driver applies
  /// instead. Real 16-bit levers return only to within 4096 of 32768 counts of the centre, while
  /// their drivers report a dead zone of 128 counts (Android, key layout of the controller
  /// 0e6f:f501).
  static constexpr double kDeadZone = 0.125;
  /// Longest time without a movement of a button or selected stick. A gamepad reports only changes: silence
  /// with a deflected stick means a still hand or a broken radio link. The keyboard releases the stick after
  /// the same time without an arrow or page key. The value is chosen, not derived.
  static constexpr double kSilence_s = 10;

  /// @pre problem_of(ranges, selected) is empty
  GamepadLaw(const StickRanges& ranges, const std::array<bool, 3>& selected, bool micro = false);

  void take(const GamepadEvent& event, double now_s);

  /// True when deflection() acts: the dead-man's button was pressed after the start and is held; since this
  /// press, the sticks of all selected axes have been in their dead zones at the same time; no return is
  /// requested; the last movement of a button or selected stick is at most kSilence_s old. After a longer
  /// silence, the operator must release the button and press it again.
  [[nodiscard]] bool engaged(double now_s) const;
  /// Deflection of the selected axes, independent of engaged(): 0 in the dead zone; at the ends of
  /// the range ±1, in micro-speed ±0.1.
  [[nodiscard]] std::array<double, 3> deflection() const;
  /// True when the dead-man's button is held, but the sticks have not been in their dead zones since it was
  /// pressed.
  [[nodiscard]] bool waits_for_centre() const { return dead_man_pressed_ && !centred_; }
  /// True while the dead-man's button is held.
  [[nodiscard]] bool dead_man_pressed() const { return dead_man_pressed_; }
  /// True once after each press of BTN_SOUTH while the dead-man's button is held.
  bool take_return();
  /// True from the press of BTN_SOUTH until take_return(), or until the dead-man's button is released.
  [[nodiscard]] bool returns() const { return returns_; }

 private:
  [[nodiscard]] bool silent(double now_s) const { return now_s - last_event_s_ > kSilence_s; }
  /// @return whether the operator has pressed or released a button of this law
  bool take_button(std::uint16_t code, int value);
  /// @return whether a selected stick has moved
  bool take_stick(std::uint16_t code, int value);

  StickRanges ranges_;
  std::array<bool, 3> selected_;
  bool micro_;                  ///< micro-speed also without BTN_TR
  bool micro_pressed_ = false;  ///< true: BTN_TR is pressed
  bool dead_man_pressed_ = false, centred_ = false, returns_ = false;
  double last_event_s_ = 0;  ///< time of the last movement of a button or selected stick
};

}  // namespace crane::cli
