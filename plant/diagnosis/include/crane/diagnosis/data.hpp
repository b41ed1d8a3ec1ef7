#pragma once
/// Measured data as the diagnosis takes them: uniform pieces of runs, checked.
#include <array>
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

/// A piece of a run without gaps. Row k: measurement at t_k, command applied from t_k on.
struct Run {
  std::string name;                                    ///< "train_1.csv", with ", part 2" after a gap
  double period_s = 0;                                 ///< > 0
  double start_s = 0;                                  ///< time of row 0
  std::vector<plant::PerAxis> command_v;               ///< 0 for a drive without a column
  std::array<std::vector<double>, kOutputs> measured;  ///< m or rad; empty when there is no such column
  std::vector<double> cable_m;                         ///< measured, or the rig's own

  [[nodiscard]] std::size_t rows() const { return command_v.size(); }
  [[nodiscard]] double duration_s() const { return static_cast<double>(rows()) * period_s; }
  [[nodiscard]] bool has(Output output) const { return !measured[output].empty(); }
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

/// Checks a table of canonical columns against the rig and cuts it at gaps into uniform pieces. Irregular
/// sampling is interpolated to the median period and said so. Angles that look like degrees, counts that
/// wrap, constant and missing columns, time that does not increase and pieces too short are problems or
/// notes.
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
[[nodiscard]] Motion smooth(std::span<const double> measured, double period_s, int half_width);
/// From a measured position by the cubic spline through the samples: its acceleration, straight between them
/// and integrated twice, gives them back.
[[nodiscard]] Motion spline(std::span<const double> measured, double period_s);

}  // namespace crane::diagnosis
