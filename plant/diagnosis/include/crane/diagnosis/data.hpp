#pragma once
/// Measured data of the diagnosis: checked runs on an equidistant grid, with measurements and commands at
/// their own times.
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "crane/plant/coordinates.hpp"
#include "crane/recording/csv.hpp"
#include "crane/stepper/kinematics.hpp"

namespace crane::diagnosis {

using stepper::axis_of, stepper::kCoordinateOf, stepper::kOutputs, stepper::Output;
using enum stepper::Output;

/// Canonical column names, in the order of Output.
inline constexpr auto kOutputNames = [] {
  std::array<const char*, kOutputs> names{};
  for (std::size_t i = 0; i < kOutputs; ++i) names[i] = plant::kCoordinates[kCoordinateOf[i]].column;
  return names;
}();

/// Drive voltages from `time_s` until the next command.
struct TimedCommand {
  double time_s = 0;  ///< since row 0 of its run
  plant::PerAxis drive_v{};
};

/// A run on an equidistant grid. Row k has the measurement nearest to start + k periods, with its own time,
/// and the command from this time on. A row with NaN was not measured; the row is simulated but not compared.
struct Run {
  std::string name;     ///< "train_1.csv", or "train_1.csv, part 2" after the state was lost
  double period_s = 0;  ///< of the grid, > 0
  double start_s = 0;   ///< time of row 0
  std::vector<plant::PerAxis> command_v;               ///< mean of the period; 0 for a drive without a column
  std::array<std::vector<double>, kOutputs> measured;  ///< m or rad; empty without a column
  std::vector<double> cable_m;                         ///< measured, or that of the rig file
  std::vector<double> offset_s;        ///< time of the row relative to the grid, within a period; empty: none
  std::vector<TimedCommand> commands;  ///< at their own times; empty: `command_v` holds from row to row
  std::array<bool, 2> commanded{true, true};  ///< trolley, slew: the command is known
  /// Trolley, slew; by row: an edge of the command may have been lost with the row. Empty: nowhere.
  std::array<std::vector<bool>, 2> edge_lost;
  double load_mass_kg = 0;  ///< 0: as in the rig file
  /// Resolution of each sensor, as the data show it, m or rad; 0: unknown.
  std::array<double, kOutputs> resolution{};

  [[nodiscard]] std::size_t rows() const { return command_v.size(); }
  [[nodiscard]] double duration_s() const { return static_cast<double>(rows()) * period_s; }
  [[nodiscard]] bool has(Output output) const { return !measured[output].empty(); }
  [[nodiscard]] bool is_measured(Output output, std::size_t row) const {
    return std::isfinite(measured[output][row]);
  }
  /// Time of a row since row 0.
  [[nodiscard]] double instant_s(std::size_t row) const {
    return static_cast<double>(row) * period_s + (offset_s.empty() ? 0.0 : offset_s[row]);
  }
  /// @param drive trolley or slew
  [[nodiscard]] bool may_have_lost_edge(Output drive, std::size_t row) const {
    return !edge_lost[drive].empty() && edge_lost[drive][row];
  }
  /// True when every row was measured at the time of its grid row.
  [[nodiscard]] bool regular(Output output) const;
};

/// Runs of one file. The notes state everything that was omitted or changed.
struct Loaded {
  std::vector<Run> runs;
  std::vector<std::string> notes;
};

/// The data cannot be used. One line per problem: "file: column: what is wrong: rule".
class DataError : public std::runtime_error {
 public:
  explicit DataError(std::vector<std::string> problems);
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

/// Checks a table of canonical columns against the rig. Rows keep their own times, so that jitter, dropped
/// rows and two sample times cause no loss of measured values. A run is cut where its state is lost: after a
/// gap of one period of the load (2 s without a load), and where a position is reset. The function reports
/// wrong units, constant or missing columns, times that do not increase, and short pieces as problems or
/// notes.
/// @param name of the file, for messages
/// @throws DataError with all problems of the table
[[nodiscard]] Loaded load_run(const recording::Table& table, const configuration::Rig& rig,
                              const std::string& name);

/// By sample: m or rad, per s, per s2.
struct Motion {
  std::vector<double> position, rate, acceleration;
};
/// Local cubic over 2 half_width + 1 samples: no phase lag, exact for cubics; one-sided at the ends (A.
/// Savitzky, M. J. E. Golay, Anal. Chem. 36 (1964) 1627).
[[nodiscard]] Motion savitzky_golay(std::span<const double> measured, double period_s, int half_width);
/// Position without sensor noise: fixed-interval smoother (H. E. Rauch, F. Tung, C. T. Striebel, AIAA J. 3
/// (1965) 1445) of a motion with white jerk, whose strength maximises the likelihood of the samples.
/// @param time_s of the samples, increasing
/// @param least_noise of the sensor, standard deviation, > 0
[[nodiscard]] std::vector<double> rts_smoothed(std::span<const double> time_s,
                                               std::span<const double> measured, double least_noise);
/// Cubic spline through the samples. The acceleration, linear between samples and integrated twice,
/// reproduces them.
[[nodiscard]] Motion spline(std::span<const double> measured, double period_s);
/// Cubic spline through samples at their own, increasing times, evaluated at 0, period, ... for `rows` rows.
/// More than one period before the first or after the last sample, the value is constant.
[[nodiscard]] Motion spline_of(std::span<const double> time_s, std::span<const double> measured,
                               double period_s, std::size_t rows);

}  // namespace crane::diagnosis
