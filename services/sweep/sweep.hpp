#pragma once
/// A sweep: every combination of scenario, rig, variant and controller, repeated with random parameters of
/// the simulated crane. A sweep file (TOML) lists the combinations and the random parameters. A run is one
/// experiment in lockstep, in one process.
///
/// Run numbers count scenario, rig, variant, controller and seed in this order; the seed varies fastest. A
/// seed draws the same crane for every controller and variant.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "crane/experiment/comparison.hpp"
#include "crane/experiment/scenario.hpp"
#include "crane/simulator/integrator.hpp"

namespace crane::sweep {

/// One parameter of the simulated crane, uniformly distributed over the seeds.
struct Draw {
  /// Key of the rig file: "plant.load_mass_kg", "start.swing_radial_rad", "model.terms.NAME.AXIS.PARAMETER".
  std::string key;
  double low = 0, high = 0;  ///< bounds, in the unit of the key
  std::string place{};       ///< "FILE:LINE: " of the key, for messages
};

/// One scenario on one rig.
struct Case {
  experiment::Scenario scenario;
  configuration::Rig rig;
};

struct Sweep {
  std::string name;  ///< file name without .toml
  std::string description;
  std::vector<Case> cases;
  std::vector<std::string> variants;     ///< names of experiment/variant.hpp; "": the unchanged rig
  std::vector<std::string> controllers;  ///< "": the controller of the rig file
  std::vector<Draw> draws;
  std::uint64_t first_seed = 1, seeds = 1;
  simulator::Method integrator = simulator::Method::cvode;  ///< of the simulated plant

  [[nodiscard]] std::size_t size() const;
};

/// Converts names of rigs and scenarios in the sweep file to files. @throws configuration::ConfigurationError
struct Finder {
  std::filesystem::path (*rig)(const std::string& name_or_path);
  std::filesystem::path (*scenario)(const std::string& name_or_path);
};
/// @throws configuration::ConfigurationError with all problems of the sweep file and of the files that it
///   names
[[nodiscard]] Sweep load_sweep(const std::filesystem::path& file, const Finder& finder);
/// As load_sweep(), from text. @param file  file name for messages and Sweep::name
[[nodiscard]] Sweep parse_sweep(const std::string& text, const std::string& file, const Finder& finder);

/// One run of a sweep. @pre number < sweep.size()
struct Run {
  std::size_t number = 0;
  const Case* on = nullptr;
  std::string variant{}, controller{};
  std::uint64_t seed = 0;
  std::vector<double> drawn{};  ///< one value per draw
};
[[nodiscard]] Run run_of(const Sweep& sweep, std::size_t number);

/// The rig of a run: applies the start of the scenario, then the drawn values, then the variant.
[[nodiscard]] configuration::Rig rig_at_start(const Sweep& sweep, const Run& run);

/// Runs one experiment. Every failure is a result.
[[nodiscard]] experiment::ComparedRun simulate(const Sweep& sweep, const Run& run);

/// Text that identifies a sweep: sweeps that can have different results have different texts.
[[nodiscard]] std::string identity_of(const Sweep& sweep);

}  // namespace crane::sweep
