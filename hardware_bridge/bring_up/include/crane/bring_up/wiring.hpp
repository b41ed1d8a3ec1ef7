#pragma once
/// Finds wiring faults from the reaction of the rig to small pushes of each drive. Pure functions.
///
/// Only the axis with the open brake can move. Therefore the counter that changes belongs to the encoder of
/// this axis. The load shows the true direction, because it lags behind its suspension point. If one of
/// drive, axis encoder and swing encoder contradicts the other two, it has the wrong sign. If several
/// explanations fit, the result is the one with the fewest faults.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "crane/bring_up/session.hpp"

namespace crane::bring_up {

/// Largest motion that counts as standstill (backlash, single counts), m or rad.
inline constexpr double kStandstill = 1e-3;
/// Largest swing that counts as no swing: about 15 counts of the encoders of the Virginia Tech rig.
inline constexpr double kNoSwing_rad = 4e-3;
inline constexpr std::size_t kSwingCount = 2;

/// Evidence from the pushes of one axis.
struct AxisEvidence {
  bool limit_open = false;     ///< true: a limit switch was open; the axis was not moved
  bool closed_at_rest = true;  ///< true: the brake contact reported closed with brake line and relay off
  /// True: the brake contact reported closed with closed relay and brake line off.
  bool closed_in_use = true;
  bool held = true;    ///< true: the closed brake held the axis within kStandstill against a push
  double slipped = 0;  ///< motion against the closed brake, m or rad
  bool opened = true;  ///< true: the brake contact opened with the brake line on
  std::array<bool, kDrives> other_opened{};  ///< contacts of other brakes that opened with this brake
  bool closed_again = true;                  ///< true: the brake closed within its closing time and two ticks
  bool pushed = false;                       ///< true: the axis was pushed outward with open brake
  double push_v = 0;                         ///< largest voltage of the push
  double drift = 0;                          ///< motion with open brake at 0 V, m or rad
  std::array<double, kDrives> moved{};       ///< motion by the counter of each axis, m or rad
  std::array<double, kSwingCount> shifted_rad{};  ///< permanent change of each swing counter at rest
  std::array<double, kSwingCount> swung_rad{};    ///< amplitude of the added swing
  double expected_rad = 0;  ///< amplitude of the swing that the measured motion should add, >= 0
  double share = 0;         ///< measured share of expected_rad (share_of())
  /// After the push, with closed brakes: swing that the counter of a drive shows, in the scale of the swing
  /// encoder.
  std::array<double, kDrives> counter_swings_rad{};
  /// As `moved`, measured with the brakes of all axes open whose push had moved nothing.
  std::array<double, kDrives> moved_unlocked{};
};

struct Evidence {
  bool estop_pressed = false;
  bool relay_closed_at_rest = false;
  bool relay_closed = true;   ///< true: the relay closed while the watchdog output toggled
  bool relay_dropped = true;  ///< true: the relay opened within relay_limit_s after the last change
  double relay_limit_s = 0;   ///< longest permitted time between last change and open relay
  std::array<AxisEvidence, kDrives> axis;
};

/// Wiring fault that judge() can report.
enum class Fault {
  estop,                  ///< the emergency stop is pressed, or its wire is broken
  relay_stuck,            ///< the relay stays closed without toggles of the watchdog output
  relay_dead,             ///< the relay does not close while the watchdog output toggles
  limit_open,             ///< a limit switch is open: the axis was not moved
  brake_contact,          ///< the brake holds, but its contact reports open
  brake_stays_open,       ///< the axis moves against the brake, and the contact reports open
  brake_slips,            ///< the axis moves against the brake, and the contact reports closed
  brake_stays_closed,     ///< the contact reports closed with the brake line on
  brakes_swapped,         ///< the contact of another brake opens
  brake_slow,             ///< the brake does not close within its closing time and two ticks
  drift,                  ///< the axis moves at 0 V with open brake
  drive_sign,             ///< a positive voltage moves the axis inward
  encoder_sign,           ///< the counter decreases when the axis moves outward
  drive_or_encoder_sign,  ///< voltage and counter disagree; no load shows which of them is wrong
  swing_sign,             ///< the swing angle has the wrong sign
  encoders_swapped,       ///< the counter of another encoder follows the axis
  drives_swapped,         ///< the voltage moves another axis
  encoder_dead,           ///< the axis moves, but its counter does not change
  drive_dead,             ///< the voltage moves no axis
  drive_or_encoder_dead,  ///< no counter changes; no load shows which of them is dead
  swing_dead              ///< the load swings, but its counter does not change
};
[[nodiscard]] std::string_view name_of(Fault fault);  ///< "encoder_sign"

struct Finding {
  Fault fault{};
  std::string subject;  ///< "trolley", "trolley, slew", "relay"
  std::string text;     ///< one line with the fault and the remedy
};

/// Counter of the swing that a motion of the axis causes: 3 (radial) for the trolley, 4 (tangential) for the
/// slew axis; 0: none.
[[nodiscard]] std::size_t swing_of(const configuration::Rig& rig, std::size_t axis);

/// @return all faults in the order of the checks; empty when the wiring agrees with the rig file
[[nodiscard]] std::vector<Finding> judge(const configuration::Rig& rig, const Evidence& evidence);

}  // namespace crane::bring_up
