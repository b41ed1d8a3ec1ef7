#pragma once
/// Draws one maneuver with gnuplot: positions and references, both swing angles and drive voltages over a
/// common time axis. Equal runs give equal bytes.
#include <filesystem>
#include <span>
#include <string>

#include "crane/experiment/metrics.hpp"

namespace crane::experiment {

struct Caption {
  std::string rig, controller, scenario;
};

/// Draws the run from the first action (time 0 of the picture) to its end, and marks the settling time.
/// @param file ends in .svg or .png; its directory must exist. @throws plot::PictureError
void draw_maneuver(const std::filesystem::path& file, const Caption& caption, std::span<const Sample> run,
                   const Maneuver& maneuver, const Metrics& metrics);

}  // namespace crane::experiment
