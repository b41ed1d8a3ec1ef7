#pragma once
/// A trolley with LastLine, tick by tick.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "crane/bridge/last_line.hpp"
#include "subject.hpp"

namespace crane::bridge::test {

inline constexpr double kPeriod_s = 0.01;

inline const configuration::Rig& tower() {
  static const auto rig = emulated_rig();
  return rig;
}

/// The same crane with homing for every axis.
inline const configuration::Rig& homing_tower() {
  static const auto rig = configuration::load_rig(CRANE_RIGS "/homing_servo_to_go.toml");
  return rig;
}

/// A trolley, its brakes and its supervisor, tick by tick. Tests change the public members.
class Timeline {
 public:
  explicit Timeline(std::span<const Check> checks = last_line_checks(),
                    const configuration::Rig& rig = tower())
      : line{last_line_parameters(rig), checks}, rig_{rig}, checks_{checks} {
    tick();
  }

  double trolley_m = 0.6, speed_mps = 0;
  double swing_rad = 0;
  std::array<double, kDrives> drive_v{};
  bool release = true, permission = true, commands_come = true;
  bool encoder_dead = false, brake_opens = true;
  double encoder_offset_m = 0;
  double converter_gives = 1;  ///< converter voltage / commanded voltage
  double converter_stuck_v = 0;
  bool limit_high = false;
  bool second_writer = false;
  double late_s = 0;  ///< delay of the sample of this tick
  /// true: the position is unknown; the axis is being homed; the axis is below its mark
  bool unknown = false, homing = false, mark = false;

  /// Places the trolley and starts a LastLine without history.
  void start_at(double position_m) {
    line = LastLine{last_line_parameters(rig_), checks_};
    outputs = {};
    trolley_m = position_m;
    tick();
  }
  /// @return true while LastLine applies the command
  bool tick(int ticks = 1) {
    for (int i = 0; i < ticks; ++i) step();
    return line.reason() == Reason::none;
  }
  /// Number of ticks until LastLine stops the crane; `most` when it does not.
  int ticks_until_stopped(int most = 50) {
    for (int i = 1; i <= most; ++i)
      if (!tick()) return i;
    return most;
  }
  void expect_safe() {
    EXPECT_EQ(outputs.drive_v, kNothing);
    EXPECT_EQ(outputs.brake_release, (std::array<bool, kDrives>{}));
    tick();
    EXPECT_FALSE(outputs.watchdog_level) << "toggles on";
    tick();
    EXPECT_FALSE(outputs.watchdog_level) << "toggles on";
  }

  LastLine line;
  Outputs outputs;
  std::optional<CommandView> command;
  std::uint64_t now = 0;

 private:
  void step() {
    ++now;
    if (commands_come)
      command = CommandView{now - 1, drive_v, {release, release, release}, permission, {homing}};
    move();
    Observation observation;
    observation.time_ns = std::llround((static_cast<double>(now) * kPeriod_s + late_s) * 1e9);
    if (!encoder_dead) shown_m_ = trolley_m + encoder_offset_m;
    const double counts_per_m = rig_.encoders[0].counts_per_unit;
    observation.counts[0] = std::llround(shown_m_ * counts_per_m);
    observation.coordinate = {static_cast<double>(observation.counts[0]) / counts_per_m, 0, 1, swing_rad, 0};
    observation.applied_v = outputs.drive_v;
    const bool open = brake_opens && outputs.brake_release[0];
    observation.brake_closed = {!open, !open, !open};
    observation.limit_high[0] = limit_high;
    observation.unknown[0] = unknown;
    observation.second_writer = second_writer;
    observation.mark[0] = mark;
    outputs = line.decide(command, now, observation);
  }
  /// Integrates the motion without friction: the trolley coasts while the brake is open.
  void move() {
    const bool open = brake_opens && outputs.brake_release[0];
    if (open)
      speed_mps += 2 * (outputs.drive_v[0] * converter_gives + converter_stuck_v) * kPeriod_s;
    else if (!slips)
      speed_mps = 0;
    trolley_m += speed_mps * kPeriod_s;
  }

 public:
  bool slips = false;

 private:
  double shown_m_ = 0.6;
  const configuration::Rig& rig_;
  std::span<const Check> checks_;
};

}  // namespace crane::bridge::test
