#pragma once
/// One rig file describes one crane: geometry, masses, drives, sensors, board, limits, controller and model
/// terms. rig_fields.hpp, plant/parameter_fields.hpp and control/*_fields.hpp state ranges and meanings;
/// docs/rig_file.md prints them. deploy/rigs/virginia_tech_tower.toml is the rig of the
/// dissertation and the annotated example.
#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "crane/control/drive_limits.hpp"
#include "crane/control/law.hpp"
#include "crane/control/operating_limits.hpp"
#include "crane/control/shaper.hpp"
#include "crane/control/zone.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::configuration {

enum class RigKind {
  tower,       ///< trolley and slew axis, with or without hoist
  gantry,      ///< trolley, with or without hoist
  drive_axis,  ///< one drive without load
  pendulum     ///< load without drive
};

/// Incremental encoder of one coordinate.
struct Encoder {
  int channel = 0;  ///< board counter channel
  /// Counts per m or rad of the coordinate, including quadrature and gear; 0: no such encoder.
  double counts_per_unit = 0;
  int sign = 1;  ///< +1 or -1: direction of counting
  /// Swing only: angle that the encoder shows while the load hangs at rest; the bridge subtracts it.
  double rest_angle_rad = 0;

  bool operator==(const Encoder&) const = default;
};

/// One motor axis: wiring, limits, brake.
struct Drive : control::DriveLimits {
  int dac_channel = 0;                ///< board analog output
  int sign = 1;                       ///< +1 or -1: direction of motion for a positive voltage
  double reference_speed = 0;         ///< planner: V_max of (3.43), m/s or rad/s
  double reference_acceleration = 0;  ///< planner: a_max of (3.43), m/s2 or rad/s2
  double reference_jerk = 0;          ///< planner: j_max of S-curves, m/s3 or rad/s3

  bool operator==(const Drive&) const = default;
};

/// Differentiators and filters of the measurement pipeline (dissertation 4.3).
struct Sensing {
  double swing_filter_ratio = 0.05;  ///< Butterworth cut-off / sampling frequency, 0: none
  std::array<bool, plant::kAxes> filter_speed{false, true,
                                              false};  ///< per axis: differentiate the filtered position
  bool filter_swing_angle = false;  ///< true: crane/state contains the filtered swing angles

  bool operator==(const Sensing&) const = default;
};

/// Digital lines of one drive. Line numbers: 0..7 port A, 8..15 port B, 16..23 port C, 24..31 port D.
struct DriveLines {
  int limit_low_input = 0, limit_high_input = 0;  ///< the contact opens at the limit
  int brake_closed_input = 0;                     ///< the contact closes with the brake
  int brake_release_output = 0;                   ///< on: 24 V to the brake, if the relay is closed
  int mark_input = -1;  ///< the contact closes while the axis is below its mark; -1: not wired

  bool operator==(const DriveLines&) const = default;
};

/// Lines of the board and their signals; Encoder and Drive have the counters and analog outputs. Inputs are
/// normally closed contacts to ground: a broken wire reads as an open contact.
struct Wiring {
  int base_address = 0x200;             ///< servo_to_go: 0x200 + 0x20 n
  std::string device = "/dev/comedi0";  ///< comedi: device file. Subdevices: those of an s626
  int counter_subdevice = 5, analog_output_subdevice = 1, input_subdevice = 2, output_subdevice = 3;
  int estop_input = 0;          ///< the contact opens when the emergency stop is pressed
  int relay_closed_input = 10;  ///< the contact closes with the watchdog relay
  int watchdog_output = 19;     ///< must toggle every tick
  double relay_timeout_s =
      0.05;  ///< the watchdog relay opens when the watchdog output is constant for longer
  std::array<DriveLines, plant::kAxes> drives{{{1, 2, 7, 16}, {3, 4, 8, 17}, {5, 6, 9, 18}}};

  bool operator==(const Wiring&) const = default;
};

struct Start {
  /// Initial position of the simulated plant and of axes with Zero::start: m, rad, m of cable.
  std::array<double, plant::kAxes> position{0.25, 0, 1.0};
  double swing_radial_rad = 0, swing_tangential_rad = 0;
  double cable_length_offset_m = 0;  ///< true minus measured cable length

  bool operator==(const Start&) const = default;
};

/// Planning of moves, for every controller whose reference is not a step.
struct Planning {
  bool limits_jerk = false;  ///< S-curve instead of bang-coast-bang
  control::Shaping shaping = control::Shaping::none;
  double planned_swing_rad = 0.17453292519943295;  ///< largest swing of a time-optimal plan
  double planned_volt_share = 0.95;  ///< share of the volts that a plan uses; the rest is left for tracking
  double planning_time_s = 0.05;     ///< time from the request of a move to the start of its plan

  bool operator==(const Planning&) const = default;
};

struct Rig {
  std::string name;
  std::string path;  ///< file that was read
  RigKind kind = RigKind::tower;
  double period_s = 0.01;   ///< tick
  plant::Parameters plant;  ///< the simulated plant
  std::vector<plant::TermSetting> terms;
  std::array<Drive, plant::kAxes> drives;
  std::array<Encoder, 5> encoders;  ///< trolley, slew, hoist, radial swing, tangential swing
  Sensing sensing;
  control::OperatingLimits limits;
  Start start;
  control::Clearance clearance;
  std::vector<control::Zone> zones;
  std::string board = "simulated";  ///< a name of boards.def
  Wiring wiring;
  std::string controller = "gain_scheduling_partial";
  Planning planning;
  control::Design design;  ///< of the controllers; design.crane equals plant without [controller.believes]

  /// True when a load can hang from this kind of rig, even if its mass is 0.
  [[nodiscard]] bool carries_load() const { return kind != RigKind::drive_axis; }
  /// True when the rig has a load that swings.
  [[nodiscard]] bool has_load() const { return carries_load() && plant.load_mass_kg > 0; }
  /// True when the rig has an encoder for this coordinate (plant/coordinates.hpp).
  [[nodiscard]] bool measures(std::size_t coordinate) const {
    return encoders[coordinate].counts_per_unit > 0;
  }
  /// Number of whole ticks within a time, at least one.
  [[nodiscard]] int ticks_in(double time_s) const;

  bool operator==(const Rig&) const = default;
};

/// All problems of the input files, one line each: "file:line: name = value: rule".
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
/// All fields of the rig as TOML, including those with their default. parse_rig() then returns the same rig,
/// bit for bit, except for its path. Values that follow from other fields (volts, lengths and period of the
/// design) are not written.
[[nodiscard]] std::string to_toml(const Rig& rig);
/// Hash of to_toml(rig) and the name of a controller: 32-bit FNV-1a. 1 replaces the hash 0, which means
/// "differs". Texts that differ in one character have different hashes, except for the pair 0 and 1; other
/// different texts have equal hashes with a probability of about 2^-32.
[[nodiscard]] std::uint32_t digest(const Rig& rig, std::string_view controller);
/// The table [[zone]] of one zone.
[[nodiscard]] std::string to_toml(const control::Zone& zone);

}  // namespace crane::configuration
