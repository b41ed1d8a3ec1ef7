#pragma once
/// One rig file describes one crane: geometry, masses, drives, sensors, board, limits, controller and model
/// terms. Ranges and meanings: rig_fields.hpp, plant/parameter_fields.hpp and control/*_fields.hpp; the same
/// in docs/rig_file.md. deploy/rigs/virginia_tech_tower.toml is the dissertation's rig and the annotated
/// example.
#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "crane/control/drive_limits.hpp"
#include "crane/control/law.hpp"
#include "crane/control/operating_limits.hpp"
#include "crane/control/shaper.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::configuration {

enum class RigKind { tower, gantry, drive_axis, pendulum };

/// Incremental encoder of one coordinate.
struct Encoder {
  int channel = 0;  ///< board counter channel
  double counts_per_unit =
      0;         ///< counts per m or rad of the coordinate (quadrature and gear included); 0: no such encoder
  int sign = 1;  ///< +1 or -1: which way it counts

  bool operator==(const Encoder&) const = default;
};

/// One motor axis: wiring, limits, brake.
struct Drive : control::DriveLimits {
  int dac_channel = 0;                ///< board analog output
  int sign = 1;                       ///< +1 or -1: which way a positive voltage moves it
  double reference_speed = 0;         ///< planner: V_max of (3.43), per second
  double reference_acceleration = 0;  ///< planner: a_max of (3.43), per second squared
  double reference_jerk = 0;          ///< planner: j_max of S-curves, per second cubed

  bool operator==(const Drive&) const = default;
};

/// Differentiators and filters of the measurement pipeline (dissertation 4.3).
struct Sensing {
  double swing_filter_ratio = 0.05;  ///< Butterworth cut-off / sampling frequency, 0: none
  std::array<bool, plant::kAxes> filter_speed{false, true,
                                              false};  ///< per axis: differentiate the filtered position
  bool filter_swing_angle = false;  ///< the swing angles themselves are passed on filtered, too

  bool operator==(const Sensing&) const = default;
};

/// Digital lines of one drive, numbered through the board: 0..7 port A, 8..15 B, 16..23 C, 24..31 D.
struct DriveLines {
  int limit_low_input = 0, limit_high_input = 0;  ///< contact opens at the limit
  int brake_closed_input = 0;                     ///< contact closes with the brake
  int brake_release_output = 0;                   ///< on: 24 V to the brake, if the relay is closed
  int mark_input = -1;                            ///< contact closes below the axis' mark; -1: not wired

  bool operator==(const DriveLines&) const = default;
};

/// What is connected to which line of the board; counters and analog outputs stand with encoders and drives.
/// Inputs are contacts to ground, closed when all is well, so that a broken wire reads as trouble.
struct Wiring {
  int base_address = 0x200;             ///< servo_to_go: 0x200 + 0x20 n
  std::string device = "/dev/comedi0";  ///< comedi: device file, and its subdevices; those of an s626
  int counter_subdevice = 5, analog_output_subdevice = 1, input_subdevice = 2, output_subdevice = 3;
  int estop_input = 0;            ///< contact opens with the emergency stop
  int relay_closed_input = 10;    ///< contact closes with the watchdog relay
  int watchdog_output = 19;       ///< has to toggle every tick
  double relay_timeout_s = 0.05;  ///< the watchdog relay drops when its input has not changed for longer
  std::array<DriveLines, plant::kAxes> drives{{{1, 2, 7, 16}, {3, 4, 8, 17}, {5, 6, 9, 18}}};

  bool operator==(const Wiring&) const = default;
};

struct Start {
  std::array<double, plant::kAxes> position{
      0.25, 0, 1.0};  ///< where the simulated plant begins, and an axis with Zero::start: m, rad, m of cable
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  double cable_length_offset_m = 0;  ///< the true cable is longer than the hoist encoder says by so much

  bool operator==(const Start&) const = default;
};

/// How moves are planned, wherever the controller does not take the bare step.
struct Planning {
  bool limits_jerk = false;  ///< S-curve instead of bang-coast-bang
  control::Shaping shaping = control::Shaping::none;
  double planned_swing_rad = 0.17453292519943295;  ///< largest swing of a time-optimal plan
  double planned_volt_share = 0.95;  ///< share of the volts that a plan uses; the rest is left for tracking
  double planning_time_s = 0.05;     ///< a plan begins so long after its request

  bool operator==(const Planning&) const = default;
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
  control::OperatingLimits limits;
  Start start;
  std::string board = "simulated";  ///< simulated (hardware boards: servo_to_go, comedi, emulated)
  Wiring wiring;
  std::string controller = "gain_scheduling_partial";
  Planning planning;
  control::Design design;  ///< what the controllers believe; crane = plant unless the file says otherwise

  /// A load can hang from this kind of rig, also where its mass is 0.
  [[nodiscard]] bool carries_load() const { return kind != RigKind::drive_axis; }
  /// There is a load that swings.
  [[nodiscard]] bool has_load() const { return carries_load() && plant.load_mass_kg > 0; }
  /// There is an encoder for this coordinate (plant/coordinates.hpp).
  [[nodiscard]] bool measures(std::size_t coordinate) const {
    return encoders[coordinate].counts_per_unit > 0;
  }
  /// Whole ticks within a time, at least one.
  [[nodiscard]] int ticks_in(double time_s) const;

  bool operator==(const Rig&) const = default;
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
/// Every field of the rig as TOML, no default left out: parse_rig() gives the same rig, bit for bit, but for
/// its path. What follows from other fields (the design's volts, lengths and period) is not written.
[[nodiscard]] std::string to_toml(const Rig& rig);

}  // namespace crane::configuration
