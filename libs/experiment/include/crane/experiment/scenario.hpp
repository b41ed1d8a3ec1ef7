#pragma once
/// A scenario describes a run independently of the controller: start positions, moves, excitations, kicks.
/// Files: deploy/scenarios/*.toml; maneuver_1.toml is an annotated example. A file may extend another file.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/control/excitation.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::experiment {

/// A request to move. Time 0 is the start of the run, with the crane in HOLD (armed, brakes open).
struct Move {
  double at_s = 0;
  std::array<std::optional<double>, plant::kAxes> target;  ///< m, rad, m of cable; nothing: the axis stays
};

/// A request that one axis follows a sum of sines or, without sines, a step.
struct Excitation {
  double at_s = 0;
  control::Excitation reference;
};

/// A disturbance: an instantaneous change of the swing rates of the load.
struct Kick {
  double at_s = 0;
  double radial_radps = 0;
  double tangential_radps = 0;
};

struct Scenario {
  std::string name;         ///< file name without .toml
  std::string description;  ///< one sentence
  std::string path;
  std::array<std::optional<double>, plant::kAxes> start;  ///< m, rad, m of cable; nothing: as in the rig file
  double swing_radial_rad = 0, swing_tangential_rad = 0;  ///< at the start
  double duration_s = 20;                                 ///< after the first move, excitation or kick
  std::vector<Move> moves;                                ///< in order of time
  std::vector<Excitation> excitations;                    ///< in order of time
  std::vector<Kick> kicks;                                ///< in order of time
  /// Least time from rest to rest that the drives permit, for comparison; nothing: unknown.
  std::optional<double> least_settling_time_s;
  std::optional<double> load_mass_kg;  ///< true load mass; the controllers use the value of the rig file
  double cable_length_offset_m = 0;    ///< true minus measured cable length
  // Defaults, which the command line can override.
  std::string rig;                       ///< name or path; empty: virginia_tech_tower
  std::vector<std::string> controllers;  ///< empty: the controller of the rig file
  std::vector<std::string> variants;     ///< names of variant.hpp; empty: the rig file as written

  [[nodiscard]] double first_action_s() const;  ///< time of the first move, excitation or kick; 0: none
  [[nodiscard]] double last_action_s() const;
  [[nodiscard]] double end_s() const { return first_action_s() + duration_s; }
};

/// @param rig  not null: targets are checked against the axes and the travel of this rig
/// @throws configuration::ConfigurationError with all problems as "file:line: name = value: rule"
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file,
                                     const configuration::Rig* rig = nullptr);
[[nodiscard]] Scenario parse_scenario(const std::string& text, const std::string& file,
                                      const configuration::Rig* rig = nullptr);

/// @return the rig with start positions, swing and true load of the scenario
[[nodiscard]] configuration::Rig with_start_of(configuration::Rig rig, const Scenario& scenario);

}  // namespace crane::experiment
