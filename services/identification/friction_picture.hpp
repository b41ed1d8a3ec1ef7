#pragma once
/// Draws measurement and model: friction over speed, and the validation steps.
#include <filesystem>
#include <vector>

#include "identification/friction_experiment.hpp"

namespace crane::identification {

struct FrictionPictureData {
  const identification::AxisRun* run;  ///< data of the multi-sine
  double cutoff_ratio, period_s;
  const std::vector<double>*compensated, *uncompensated, *model;  ///< positions of the steps
};

/// @throws plot::PictureError
void draw_friction(const std::filesystem::path& file, const FrictionExperimentResult& result,
                   const FrictionPictureData& data);

}  // namespace crane::identification
