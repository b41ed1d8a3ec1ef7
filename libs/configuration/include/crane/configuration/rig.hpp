#pragma once
/// One rig file describes one crane: geometry, masses, drives, sensors, board, limits, controller and model
/// terms. deploy/rigs/virginia_tech_tower.toml is the dissertation's rig and the annotated example.
#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "crane/control/drive_limits.hpp"
#include "crane/control/law.hpp"
#include "crane/control/shaper.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::configuration {

enum class RigKind { tower, gantry, drive_axis, pendulum };

/// Incremental encoder of one coordinate.
struct Encoder {
  int channel = 0;  ///< board counter channel, 0..7
  double counts_per_unit =
      0;         ///< counts per m or rad of the coordinate (quadrature and gear included); 0: no such encoder
  int sign = 1;  ///< +1 or -1: which way it counts
};

/// One motor axis: wiring, limits, brake.
struct Drive : control::DriveLimits {
  int dac_channel = 0;                ///< board analog output, 0..7
  int sign = 1;                       ///< +1 or -1: which way a positive voltage moves it
  double reference_speed = 0;         ///< planner: V_max of (3.43), per second, > 0
  double reference_acceleration = 0;  ///< planner: a_max of (3.43), per second squared, > 0
  double reference_jerk = 0;          ///< planner: j_max of S-curves, per second cubed, > 0
};

/// Differentiators and filters of the measurement pipeline (dissertation 4.3).
struct Sensing {
  double swing_filter_ratio = 0.05;  ///< Butterworth cut-off / sampling frequency, in (0, 0.5); 0: none
  std::array<bool, plant::kAxes> filter_speed{false, true,
                                              false};  ///< per axis: differentiate the filtered position
  bool filter_swing_angle = false;  ///< the swing angles themselves are passed on filtered, too
};

/// Digital lines of one drive, numbered through the board: 0..7 port A, 8..15 B, 16..23 C, 24..31 D.
struct DriveLines {
  int limit_low_input = 0, limit_high_input = 0;  ///< contact opens at the limit
  int brake_closed_input = 0;                     ///< contact closes with the brake
  int brake_release_output = 0;                   ///< on: 24 V to the brake, if the relay is closed
  int mark_input = -1;                            ///< contact closes below the axis' mark; -1: not wired
};

/// What is connected to which line of the board; counters and analog outputs stand with encoders and drives.
/// Inputs are contacts to ground, closed when all is well, so that a broken wire reads as trouble.
struct Wiring {
  int base_address = 0x200;             ///< servo_to_go: 0x200 + 0x20 n, n = 0..15
  std::string device = "/dev/comedi0";  ///< comedi: device file, and its subdevices; those of an s626
  int counter_subdevice = 5, analog_output_subdevice = 1, input_subdevice = 2, output_subdevice = 3;
  int estop_input = 0;            ///< 0..15; contact opens with the emergency stop
  int relay_closed_input = 10;    ///< 0..15; contact closes with the watchdog relay
  int watchdog_output = 19;       ///< 16..31; has to toggle every tick
  double relay_timeout_s = 0.05;  ///< the watchdog relay drops when its input has not changed for longer
  std::array<DriveLines, plant::kAxes> drives{{{1, 2, 7, 16}, {3, 4, 8, 17}, {5, 6, 9, 18}}};
};

struct Limits {
  double swing_limit_rad = 0.7;      ///< trip when either swing angle exceeds it
  int stale_after_ticks = 5;         ///< bridge: command age that stops the crane
  int demand_stale_after_ticks = 3;  ///< supervisor: missing demands in a row that stop the crane
  double idle_lock_s = 60;           ///< HOLD without a move for so long locks the crane
};

struct Start {
  std::array<double, plant::kAxes> position{
      0.25, 0, 1.0};  ///< where the simulated plant begins, and an axis with Zero::start: m, rad, m of cable
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  double cable_length_offset_m = 0;  ///< the true cable is longer than the hoist encoder says by so much
};

/// How moves are planned, wherever the controller does not take the bare step.
struct Planning {
  bool limits_jerk = false;  ///< S-curve instead of bang-coast-bang
  control::Shaping shaping = control::Shaping::none;
};

struct Rig {
  std::string name;
  std::string path;  ///< file it came from
  RigKind kind = RigKind::tower;
  double period_s = 0.01;   ///< tick
  plant::Parameters plant;  ///< the simulated plant
  std::vector<plant::TermSetting> terms;
  std::array<Drive, plant::kAxes> drives;
  std::array<Encoder, 5> encoders;  ///< trolley, slew, hoist, radial swing, tangential swing
  Sensing sensing;
  Limits limits;
  Start start;
  std::string board = "simulated";  ///< simulated (hardware boards: servo_to_go, comedi, emulated)
  Wiring wiring;
  std::string controller = "gain_scheduling_partial";
  Planning planning;
  control::Design design;  ///< what the controllers believe; crane = plant unless the file says otherwise
};

/// Every problem of the input files at once, one line each: "file:line: name = value: rule".
class ConfigurationError : public std::runtime_error {
 public:
  explicit ConfigurationError(std::vector<std::string> problems);
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

/// @throws ConfigurationError
[[nodiscard]] Rig load_rig(const std::filesystem::path& file);
/// Same, from text; `file` is used in messages only. @throws ConfigurationError
[[nodiscard]] Rig parse_rig(const std::string& text, const std::string& file);

}  // namespace crane::configuration
