#pragma once
/// One recorded run: an experiment under a controller, measured row by row.
#include <optional>

#include "crane.hpp"
#include "nuisance.hpp"

namespace mujoco_truth {

enum class Experiment { moves, sines, sweep, steps, free_swing };
[[nodiscard]] const char* name_of(Experiment experiment);

struct RunPlan {
  Experiment experiment = Experiment::moves;
  double duration_s = 30;
  double cable_m = 1;      ///< stated length of this run
  double amplitude = 1;    ///< amplitude of the motion / amplitude that the travel suggests
  double swing_rad = 0;    ///< at the start
  std::uint64_t seed = 1;  ///< of references, disturbance, noise and rows
};

struct Row {
  double time_s = 0;
  std::array<double, kAxes> command_v{}, position{};
  std::array<double, kSwings> swing{};
};

struct Run {
  RunPlan plan;
  std::vector<Row> rows;    ///< rows of the file
  std::vector<Pose> poses;  ///< true poses at the times of the rows, only for checks
};

/// @return nothing when the crane left its travel or the load was thrown
[[nodiscard]] std::optional<Run> recorded(const Physics& physics, const Nuisance& nuisance,
                                          const RunPlan& plan);

}  // namespace mujoco_truth
