#pragma once
/// Where the windows of a part lie: around the gaps in what moves it.
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// Rows compared; the replay begins `lead` rows earlier so that sensors and filters have a past.
struct Window {
  std::size_t run = 0, first = 0, rows = 0, lead = 0;
};

/// Rows of runs in windows of about `window_s`, each run divided into equal parts; an infinite one is a whole
/// run. A window does not reach over a gap in which the measured motion that the part goes by, of the drives
/// for the load and of the load for the drives, is not known: longer than a sixteenth of the load's period
/// and than two and a half of the column's own rows. It has at least some measured rows of every output.
/// @param natural_radps of the swing; 0: not known, no gap ends a window
[[nodiscard]] std::vector<Window> windows_of(const Runs& runs, Part part, double window_s, double lead_s,
                                             double natural_radps);

/// Distance of measured rows of an output, s: half of them are nearer together.
[[nodiscard]] double usual_row_spacing_s(const Run& run, Output output);

}  // namespace crane::diagnosis
