#pragma once
/// A scenario says what is asked of a rig, independent of controller: where it starts, moves, excitations,
/// kicks. Files: deploy/scenarios/*.toml; maneuver_1.toml is the annotated example; a file may extend
/// another.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/control/excitation.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::experiment {

/// A request to move. Times count from the moment the crane holds (armed, brakes open).
struct Move {
  double at_s = 0;
  std::array<std::optional<double>, plant::kAxes> target;  ///< m, rad, m of cable; nothing: the axis stays
};

/// A request to follow a sum of sines with one axis, or, without sines, a step of its reference.
struct Excitation {
  double at_s = 0;
  control::Excitation reference;
};

/// A disturbance: the load gets these swing rates added at once.
struct Kick {
  double at_s = 0;
  double radial_radps = 0;
  double tangential_radps = 0;
};

struct Scenario {
  std::string name;         ///< file name without .toml
  std::string description;  ///< one sentence
  std::string path;
  std::array<std::optional<double>, plant::kAxes> start;  ///< m, rad, m of cable; nothing: the rig's own
  double swing_radial_rad = 0, swing_tangential_rad = 0;  ///< at the start
  double duration_s = 20;                                 ///< after the first move, excitation or kick
  std::vector<Move> moves;                                ///< in order of time
  std::vector<Excitation> excitations;                    ///< in order of time
  std::vector<Kick> kicks;                                ///< in order of time
  std::optional<double> load_mass_kg;  ///< true load; the controllers go on believing the rig file
  double cable_length_offset_m = 0;    ///< the true cable is longer than its measurement by so much
  // What it is usually run with; whoever runs it may say otherwise.
  std::string rig;                       ///< name or path, empty: the dissertation's
  std::vector<std::string> controllers;  ///< empty: the rig's
  std::vector<std::string> variants;     ///< of variant.hpp, empty: the rig as it is

  [[nodiscard]] double first_action_s() const;  ///< first move, excitation or kick, 0 when there is none
  [[nodiscard]] double last_action_s() const;
  [[nodiscard]] double end_s() const { return first_action_s() + duration_s; }
};

/// @throws configuration::ConfigurationError with every problem as "file:line: name = value: rule": unknown
/// keys, wrong
///   types, and with `rig` also targets outside its travel or on axes it does not have
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file,
                                     const configuration::Rig* rig = nullptr);
[[nodiscard]] Scenario parse_scenario(const std::string& text, const std::string& file,
                                      const configuration::Rig* rig = nullptr);

/// The rig as the scenario starts it: positions, swing and true load.
[[nodiscard]] configuration::Rig started_by(configuration::Rig rig, const Scenario& scenario);

}  // namespace crane::experiment
