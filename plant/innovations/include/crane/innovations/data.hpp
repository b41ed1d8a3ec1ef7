#pragma once
/// Measured data at their own times: one series per column, no common grid, gaps left as they are.
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "crane/recording/csv.hpp"
#include "crane/runtime/rig.hpp"

namespace crane::innovations {

/// Finite values at increasing times. Empty: there is no such column.
struct Series {
  std::vector<double> time_s, value;

  [[nodiscard]] std::size_t size() const { return value.size(); }
  [[nodiscard]] bool empty() const { return value.empty(); }
};

/// Drives and directions of swing.
enum Drive : std::size_t { kTrolley = 0, kSlew = 1 };
enum Swing : std::size_t { kRadial = 0, kTangential = 1 };
inline constexpr std::array<const char*, 2> kDriveNames{"trolley", "slew"},
    kSwingNames{"radial", "tangential"};

/// What a sensor measures. Position and swing of number i are channels i and 2 + i.
inline constexpr std::size_t kChannels = 4;
inline constexpr std::array<const char*, kChannels> kChannelNames{"trolley_position_m", "slew_angle_rad",
                                                                  "swing_radial_rad", "swing_tangential_rad"};

/// One recording. A command acts from its time on.
struct Run {
  std::string name;
  std::array<Series, 2> command;               ///< V
  std::array<Series, kChannels> measured;      ///< m or rad, in the order of kChannelNames
  Series cable;                                ///< m; empty: the rig's own
  std::array<double, kChannels> resolution{};  ///< smallest step between values, m or rad; 0: no such column

  [[nodiscard]] const Series& position(std::size_t drive) const { return measured[drive]; }
  [[nodiscard]] const Series& swing(std::size_t direction) const { return measured[2 + direction]; }
  [[nodiscard]] double begin_s() const;  ///< of the measured series, the earliest
  [[nodiscard]] double end_s() const;
  [[nodiscard]] std::size_t values() const;  ///< measured ones, all columns
};

/// One line per problem: "file: column: what is wrong".
class DataProblem : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LoadedRun {
  Run run;
  std::vector<std::string> notes;
};

/// Columns of the rig's kind, each with its finite values. Rows whose time does not increase are left out and
/// counted in the notes.
/// @throws DataProblem when nothing is measured or there are fewer than kLeastRows rows
[[nodiscard]] LoadedRun load_run(const recording::Table& table, const runtime::Rig& rig,
                                 const std::string& name);

/// The part of a run from `from_s` to `to_s`, with the commands of a second before.
[[nodiscard]] Run cut(const Run& run, double from_s, double to_s);

/// Smallest step between different values that 2 % of the steps do not undercut.
[[nodiscard]] double resolution_of(const std::vector<double>& values);

}  // namespace crane::innovations
