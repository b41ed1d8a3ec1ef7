#pragma once
/// A picture of one maneuver: positions with their references, both swing angles and the drive voltages over
/// a common time axis, drawn by gnuplot. Same run, same bytes.
#include <filesystem>
#include <span>
#include <string>

#include "crane/experiment/metrics.hpp"

namespace crane::experiment {

struct Caption {
  std::string rig, controller, scenario;
};

/// Draws from the first action (time 0 of the picture) to the end of the run, the settling time marked.
/// @param file ends in .svg or .png; its directory must exist. @throws plot::PictureError
void draw_maneuver(const std::filesystem::path& file, const Caption& caption, std::span<const Sample> run,
                   const Maneuver& maneuver, const Metrics& metrics);

}  // namespace crane::experiment
