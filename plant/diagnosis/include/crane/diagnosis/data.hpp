#pragma once
/// Measured data as the diagnosis takes them: runs on the grid that a replay goes by, measurements and
/// commands at their own times, checked.
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

namespace crane::diagnosis {

/// What sensors report and a simulation has to reproduce.
enum Output : std::size_t { kTrolleyPosition = 0, kSlewAngle = 1, kRadialSwing = 2, kTangentialSwing = 3 };
inline constexpr std::size_t kOutputs = 4;
/// Coordinate of each output.
inline constexpr std::array<std::size_t, kOutputs> kCoordinateOf{
    plant::kTrolley, plant::kSlew, plant::kSwingRadial, plant::kSwingTangential};
/// Canonical column names, in the order of Output.
inline constexpr auto kOutputNames = [] {
  std::array<const char*, kOutputs> names{};
  for (std::size_t i = 0; i < kOutputs; ++i) names[i] = plant::kCoordinates[kCoordinateOf[i]].column;
  return names;
}();

/// Of the drive, or the direction of the swing.
[[nodiscard]] constexpr const char* axis_of(Output output) {
  return plant::kCoordinates[kCoordinateOf[output]].axis;
}

/// Volts of the drives from a time on, until the next one.
struct TimedCommand {
  double time_s = 0;  ///< since row 0 of its run
  plant::PerAxis drive_v{};
};

/// A run on a grid of equal periods. Row k: the measurement at its own instant near start + k periods, the
/// command from there on. A row that was not measured is NaN: it is simulated, and never compared.
struct Run {
  std::string name;                       ///< "train_1.csv", with ", part 2" where the state was lost
  double period_s = 0;                    ///< of the grid, > 0
  double start_s = 0;                     ///< time of row 0
  std::vector<plant::PerAxis> command_v;  ///< mean of the period; 0 for a drive without a column
  std::array<std::vector<double>, kOutputs> measured;  ///< m or rad; empty when there is no such column
  std::vector<double> cable_m;                         ///< measured, or the rig's own
  std::vector<double> offset_s;  ///< by row, of its instant from the grid's, within a period; empty: none
  std::vector<TimedCommand> commands;         ///< as they were given; empty: one a row, `command_v`
  std::array<bool, 2> commanded{true, true};  ///< whether the command of trolley and slew is known
  /// By row, of trolley and slew: whether an edge of the command may have been lost with the row; empty:
  /// nowhere.
  std::array<std::vector<bool>, 2> edge_lost;
  double load_mass_kg = 0;  ///< of this run; 0: the rig's own
  /// Smallest step of each sensor that the data show; 0: not known.
  std::array<double, kOutputs> resolution{};

  [[nodiscard]] std::size_t rows() const { return command_v.size(); }
  [[nodiscard]] double duration_s() const { return static_cast<double>(rows()) * period_s; }
  [[nodiscard]] bool has(Output output) const { return !measured[output].empty(); }
  [[nodiscard]] bool seen(Output output, std::size_t row) const {
    return std::isfinite(measured[output][row]);
  }
  /// Instant of a row since row 0.
  [[nodiscard]] double instant_s(std::size_t row) const {
    return static_cast<double>(row) * period_s + (offset_s.empty() ? 0.0 : offset_s[row]);
  }
  /// @param drive trolley or slew
  [[nodiscard]] bool may_have_lost_edge(Output drive, std::size_t row) const {
    return !edge_lost[drive].empty() && edge_lost[drive][row];
  }
  /// Whether every row was measured, at the grid's times.
  [[nodiscard]] bool regular(Output output) const;
};

/// What was noticed and what was done about it; nothing is mended without a word here.
struct Loaded {
  std::vector<Run> runs;
  std::vector<std::string> notes;
};

/// The data cannot be used; one line per problem: "file: column: what is wrong: rule".
class DataError : public std::runtime_error {
 public:
  explicit DataError(std::vector<std::string> problems);
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::vector<std::string> problems_;
};

/// Checks a table of canonical columns against the rig. Rows keep their own times: dropped rows, jitter and
/// two sample times cost nothing but what was not measured. A run is cut only where its state is lost: after
/// a gap of a whole swing (two seconds without a load), and where a position is set to another value. Angles
/// that look like degrees, counts that wrap, constant and missing columns, time that does not increase and
/// pieces too short are problems or notes.
/// @param name of the file, for messages
/// @throws DataError with all problems of the table
[[nodiscard]] Loaded load_run(const recording::Table& table, const configuration::Rig& rig,
                              const std::string& name);

/// By sample.
struct Motion {
  std::vector<double> position, rate, acceleration;
};
/// From a measured position by a local cubic over 2 half_width + 1 samples: no phase lag; exact for cubics.
/// At the ends the window is one-sided.
[[nodiscard]] Motion savitzky_golay(std::span<const double> measured, double period_s, int half_width);
/// A measured position without the noise of its sensor, at the samples' own, increasing times: the
/// fixed-interval smoother (H. E. Rauch, F. Tung, C. T. Striebel, AIAA J. 3 (1965) 1445) of a motion whose
/// jerk is white, as strong as makes the samples likeliest.
/// @param least_noise of the sensor, standard deviation, > 0
[[nodiscard]] std::vector<double> rts_smoothed(std::span<const double> time_s,
                                               std::span<const double> measured, double least_noise);
/// From a measured position by the cubic spline through the samples: its acceleration, straight between them
/// and integrated twice, gives them back.
[[nodiscard]] Motion spline(std::span<const double> measured, double period_s);
/// The cubic spline through samples at their own, increasing times, at the instants 0, period, ... of
/// `rows` rows. A period before the first sample and after the last one it stands still.
[[nodiscard]] Motion spline_of(std::span<const double> time_s, std::span<const double> measured,
                               double period_s, std::size_t rows);

}  // namespace crane::diagnosis
