#pragma once
/// Compares laws and gains in simulated maneuvers of one rig and selects one of them.
///
/// Every candidate runs the maneuvers on the identified rig. Candidates that settle are ranked by their mean
/// settling time. The best candidates are tested with longer delay, larger gain, and changed cable length,
/// load and friction. Candidates with the required margins run the maneuvers on rigs drawn from the standard
/// errors of the identification. The recommendation is the candidate with the shortest predicted settling
/// time of those that settle on all drawn rigs.
#include <array>
#include <functional>
#include <optional>
#include <span>

#include "crane/experiment/scenario.hpp"
#include "crane/simulator/integrator.hpp"
#include "tuning/candidates.hpp"
#include "tuning/margins.hpp"

namespace crane::tuning {

/// Settling times on the identified and the drawn rigs: mean over the maneuvers.
struct Predicted {
  double mean_s = 0, least_s = 0, largest_s = 0;
};

struct Entry {
  Candidate candidate;
  std::vector<std::optional<double>> settling_s{};  ///< by maneuver
  std::optional<double> mean_settling_s{};          ///< nothing: not all maneuvers settle
  double largest_swing_rad = 0;
  std::string stopped_because{};     ///< cause of the first run that the supervisor stopped
  std::optional<Margins> margins{};  ///< nothing: not tested
  /// Nothing: the entry lacks a required margin, or does not settle on all drawn rigs.
  std::optional<Predicted> predicted{};
};

struct Recommendation {
  std::vector<std::string> maneuvers;
  std::vector<Entry> entries;  ///< by rank: entries that settle first
  /// Index of the recommended entry; nothing: no entry has the required margins and settles on all drawn
  /// rigs.
  std::optional<std::size_t> winner;
};
/// @return number of entries that settle; of these with the required margins; of these that settle on all
///   drawn rigs
[[nodiscard]] std::array<std::size_t, 3> counts(const Recommendation& recommendation);

struct Search {
  const configuration::Rig& truth;              ///< the board simulates this rig
  const configuration::Rig& rig;                ///< rig file of the control loop
  std::span<const configuration::Rig> drawn{};  ///< drawn_rigs(); empty: the truth is known
  std::span<const experiment::Scenario> maneuvers;
  std::span<const Candidate> candidates;
  unsigned processors = 1;  ///< number of threads
  simulator::Method integrator = simulator::Method::fast;
  /// Called after each run with the number of finished runs; calls do not overlap.
  std::function<void(std::size_t)> progress{};
};
/// The candidates change [controller] of the rig file.
[[nodiscard]] Recommendation recommend(const Search& search);

/// Runs one candidate in all maneuvers, without margins.
[[nodiscard]] Entry evaluate(const configuration::Rig& truth, const configuration::Rig& rig,
                             const Candidate& candidate, std::span<const experiment::Scenario> maneuvers,
                             simulator::Method integrator);

/// Maneuvers 1 to 3 that this rig can execute: with its cable length, and within its axes and limits.
/// @param files  of the scenarios
[[nodiscard]] std::vector<experiment::Scenario> maneuvers_for(const configuration::Rig& rig,
                                                              std::span<const std::filesystem::path> files);

}  // namespace crane::tuning
