#pragma once
/// Assigns rows at their own times to an equidistant grid.
///
/// A row belongs to the nearest grid row and keeps its time offset: the prediction is evaluated at the row's
/// own time inside a step. Error of the swing over 8 s, with the support known at jittered rows: below 5e-5
/// rad at 100 Hz (1/8 of an encoder count), 3.0e-4 rad at 29 Hz (1/3 of a camera's noise; data_grid_test).
/// Missing rows are NaN.
#include <vector>

#include "data/columns.hpp"

namespace crane::diagnosis {

/// Periods of the grid and of the rows.
struct Grid {
  double row_s = 0;     ///< usual time between rows
  double period_s = 0;  ///< rows_in_period * row_s: at most 10 ms, or one row
  std::size_t rows_in_period = 1;
};
/// @param time_s increasing, at least two
[[nodiscard]] Grid grid_of(const std::vector<double>& time_s);

/// Rows that were left out.
struct LeftOut {
  std::size_t crowded = 0;  ///< rows closer together than the grid
  bool own_times = false;   ///< some rows have a time offset
};
/// @param rows of the columns, increasing
/// @param cable_m without a measured cable length
[[nodiscard]] Run on_grid(const Columns& columns, const std::vector<std::size_t>& rows, const Grid& grid,
                          double cable_m, LeftOut& left_out);

/// Mean of the command over each of `count` steps from 0 on; a command holds until the next.
[[nodiscard]] std::vector<plant::PerAxis> mean_commands(const std::vector<TimedCommand>& commands,
                                                        double step_s, std::size_t count);

}  // namespace crane::diagnosis
