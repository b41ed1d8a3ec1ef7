#pragma once
/// Which wire is wrong, judged from what small pushes of each drive did. Pure functions of measurements.
///
/// With one brake open only one axis can move, so a counter that moves with it is its encoder. The load tells
/// the true direction: it stays behind when its suspension moves. So of drive, axis encoder and swing encoder
/// the one that disagrees with the other two is wired the wrong way round; of several explanations the one
/// with the fewest faults is named.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "crane/bring_up/session.hpp"

namespace crane::bring_up {

/// Motion below is none: play and the last counts. m or rad.
inline constexpr double kStandstill = 1e-3;
/// Swing below is none, a dozen counts of the tower's encoders. rad
inline constexpr double kNoSwing_rad = 4e-3;
inline constexpr std::size_t kSwings = 2;

/// One axis, pushed.
struct AxisEvidence {
  bool limit_open = false;                   ///< a limit switch was open before: the axis has not been moved
  bool closed_at_rest = true;                ///< brake contact with brake line and relay off
  bool closed_in_use = true;                 ///< ... with the relay closed, brake line off
  bool held = true;                          ///< pushed against the closed brake it stayed within kStandstill
  double slipped = 0;                        ///< how far it came, m or rad
  bool opened = true;                        ///< brake contact opened with the brake line on
  std::array<bool, kDrives> other_opened{};  ///< contacts of other brakes that opened with it
  bool closed_again = true;                  ///< within its closing time and two ticks
  bool pushed = false;                       ///< with its brake open, volts that should move it outward
  double push_v = 0;                         ///< largest
  double drift = 0;                          ///< motion with open brake at 0 V, m or rad
  std::array<double, kDrives> moved{};       ///< by each axis's counter, m or rad
  std::array<double, kSwings> shifted_rad{};  ///< by each swing counter for good: where it came to rest
  std::array<double, kSwings> swung_rad{};    ///< swing that has been added
  /// Swing its suspension's motion should have added, for the encoder as it counts; and the share seen
  /// (share_of).
  double expected_rad = 0;
  double share = 0;
  /// Afterwards, brakes closed: swing that a drive's counter shows, read as one of the swing encoder's.
  std::array<double, kDrives> counter_swings_rad{};
  std::array<double, kDrives> moved_unlocked{};  ///< as `moved`, with all brakes open that seemed not to open
};

struct Evidence {
  bool estop_pressed = false;
  bool relay_closed_at_rest = false;
  bool relay_closed = true;   ///< while the watchdog output toggled
  bool relay_dropped = true;  ///< within its time after the last change
  double relay_limit_s = 0;   ///< that time
  std::array<AxisEvidence, kDrives> axis;
};

enum class Fault {
  estop,
  relay_stuck,
  relay_dead,
  limit_open,
  brake_contact,
  brake_open,
  brake_slips,
  brake_shut,
  brakes_swapped,
  brake_slow,
  drifts,
  drive_sign,
  encoder_sign,
  drive_or_encoder_sign,
  swing_sign,
  encoders_swapped,
  drives_swapped,
  encoder_dead,
  drive_dead,
  drive_or_encoder_dead,
  swing_dead
};
[[nodiscard]] std::string_view name_of(Fault fault);  ///< "encoder_sign"

struct Finding {
  Fault fault{};
  std::string subject;  ///< "trolley", "trolley, slew", "relay"
  std::string text;     ///< one line: what is wrong, what to do
};

/// The swing that an axis's motion makes: 3 radial for the trolley, 4 tangential for the slew; 0: none.
[[nodiscard]] std::size_t swing_of(const configuration::Rig& rig, std::size_t axis);

/// Everything wrong, in the order of the checks; empty: the wiring is that of the rig file.
[[nodiscard]] std::vector<Finding> judge(const configuration::Rig& rig, const Evidence& evidence);

}  // namespace crane::bring_up
