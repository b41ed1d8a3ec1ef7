#pragma once
/// Reviews a recording: states, faults with their first causes, figures and curves, as sentences and as a
/// page.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "crane/recording/mcap_reader.hpp"
#include "crane/report/page.hpp"
#include "observation/fault_timeline.hpp"
#include "observation/traffic.hpp"

namespace crane::review {

/// State of the supervisor, with the time at which it began.
struct Phase {
  std::int64_t at_ns = 0;
  std::uint64_t tick = 0;
  crane_SupervisorState state = crane_STATE_BOOT;
  crane_Cause cause = crane_CAUSE_NONE;
};

/// One row per tick of crane/state, with the newest samples of the other topics.
struct Curves {
  std::vector<double> time_s;
  std::array<std::vector<double>, 3> position, reference;  ///< by axis: m, deg, m of cable
  std::array<std::vector<double>, 3> volts;                ///< by axis
  std::vector<double> radial_deg, tangential_deg;
};

struct AxisFigures {
  double largest_speed = 0;  ///< m/s or deg/s
  double largest_volts = 0;
  double largest_error = 0;  ///< largest |reference - position| while armed, m or deg
  double saturated_s = 0;    ///< time with |V| at the limit of the drive
};

struct Review {
  std::string file;
  std::int64_t begin_ns = 0, end_ns = 0;
  bool wall_clock = false;  ///< false: the times are those of a simulation
  std::vector<observation::Fault> faults;
  std::optional<observation::Note> trigger;  ///< first cause in the metadata of the black box
  std::vector<Phase> phases;
  Curves curves;
  std::array<AxisFigures, 3> axes;
  double largest_radial_deg = 0, largest_tangential_deg = 0;
  std::vector<observation::TopicTraffic> topics;  ///< in the order of topics::kAll
  std::vector<std::string> problems;              ///< damage of the file

  /// The stop that the review explains, in order of preference: the stop with the trigger; the first fault;
  /// the first stop by the operator; the first other intended stop (disarm, idle time, homing); a
  /// stop that began before the recording. nullptr: no stop.
  [[nodiscard]] const observation::Fault* first_stop() const;
  /// The note that determines first_stop().
  [[nodiscard]] const observation::Note* first_cause() const;
};

/// Reads all intact parts of the file. @throws recording::ReadError when the file is not a recording of this
/// version
[[nodiscard]] Review review(const std::filesystem::path& file);

/// The review as sentences; the first sentence names the first cause.
[[nodiscard]] std::vector<std::string> sentences(const Review& review);
/// Commands for a further analysis.
[[nodiscard]] std::vector<std::string> next_commands(const Review& review);
[[nodiscard]] report::Page page_of(const Review& review);
/// The review as JSON, with the curves of the page thinned to at most `most_points` rows.
[[nodiscard]] nlohmann::ordered_json to_json(const Review& review, std::size_t most_points);

}  // namespace crane::review
