#pragma once
/// Windows of a part, outside gaps of the motion that excites it.
#include <vector>

#include "crane/diagnosis/replay.hpp"

namespace crane::diagnosis {

/// Rows that are compared. The simulation starts `lead` rows earlier, which fill the memory of sensors.
struct Window {
  std::size_t run = 0, first = 0, rows = 0, lead = 0;
};

/// Divides each run into equal windows of about `window_s`; kWholeRun: one window. A window ends at a gap of
/// the prescribed motion (of the drives for the load, of the load for the drives) that is longer than
/// kLongestGap_periods of the load and kLongestGap_rows of the column. A window has at least kFewestRows
/// measured rows of each output.
/// @param natural_radps of the swing; 0: gaps do not end windows
[[nodiscard]] std::vector<Window> windows_of(const Runs& runs, Part part, double window_s, double lead_s,
                                             double natural_radps);

/// Median time between measured rows of an output, s.
[[nodiscard]] double usual_row_spacing_s(const Run& run, Output output);

}  // namespace crane::diagnosis
