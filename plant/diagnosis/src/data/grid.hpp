#pragma once
/// Rows at their own times, put on the grid that a replay goes by.
///
/// A replay takes fixed steps. Each row belongs to the grid row nearest to it and keeps its distance from it:
/// the prediction is evaluated at the row's own instant inside the step that it falls into, with that step's
/// acceleration. Measured error of the swing over 8 s, the motion of the support known at jittered rows only:
/// below 5e-5 rad at 100 Hz, 3.0e-4 rad at 29 Hz, an eighth of an encoder's count and a third of a camera's
/// noise (data_grid_test). Rows that were not measured are NaN.
#include <vector>

#include "data/columns.hpp"

namespace crane::diagnosis {

/// Periods of the grid and of the rows.
struct Grid {
  double row_s = 0;     ///< usual time from a row to the next
  double period_s = 0;  ///< a whole number of them, 10 ms at most unless the rows are further apart
  std::size_t rows_in_period = 1;
};
/// @param time_s increasing, at least two
[[nodiscard]] Grid grid_of(const std::vector<double>& time_s);

/// What was left out.
struct LeftOut {
  std::size_t crowded = 0;  ///< rows closer together than the grid
  bool own_times = false;   ///< some rows lie between those of the grid
};
/// @param rows of the columns, increasing
/// @param cable_m where no column measures it
[[nodiscard]] Run on_grid(const Columns& columns, const std::vector<std::size_t>& rows, const Grid& grid,
                          double cable_m, LeftOut& left_out);

/// Means of the command over `count` steps from 0 on, each held until the next one.
[[nodiscard]] std::vector<plant::PerAxis> mean_commands(const std::vector<TimedCommand>& commands,
                                                        double step_s, std::size_t count);

}  // namespace crane::diagnosis
