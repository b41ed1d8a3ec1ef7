#pragma once
/// What happened in a recording, in sentences and figures, first cause first; also as a self-contained page.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "crane/recording/mcap_reader.hpp"
#include "crane/report/page.hpp"
#include "observation/fault_timeline.hpp"
#include "observation/traffic.hpp"

namespace crane::review {

/// The supervisor's state from a time on.
struct Phase {
  std::int64_t at_ns = 0;
  std::uint64_t tick = 0;
  crane_SupervisorState state = crane_STATE_BOOT;
  crane_Cause cause = crane_CAUSE_NONE;
};

/// One row per tick of crane/state; the others are the newest that were heard. Angles in degrees.
struct Curves {
  std::vector<double> time_s;
  std::array<std::vector<double>, 3> position, reference, volts;
  std::vector<double> radial_deg, tangential_deg;
};

struct AxisFigures {
  double largest_speed = 0, largest_volts = 0;
  double largest_error = 0;  ///< reference minus position while armed
  double saturated_s = 0;    ///< time at the limit of the drive
};

struct Review {
  std::string file;
  std::int64_t begin_ns = 0, end_ns = 0;
  bool wall_clock = false;  ///< false: times are those of a simulation
  std::vector<observation::Fault> faults;
  std::vector<Phase> phases;
  Curves curves;
  std::array<AxisFigures, 3> axes;
  double largest_radial_deg = 0, largest_tangential_deg = 0;
  std::vector<observation::TopicTraffic> topics;  ///< in the order of topics::kAll
  std::vector<std::string> problems;              ///< of the file

  /// The first fault; without one the first stop that was ordered; nullptr: nothing stopped the crane.
  [[nodiscard]] const observation::Fault* first_stop() const;
  /// The note of first_stop() that went wrong first: an order of the operator is a cause only when no fault
  /// follows.
  [[nodiscard]] const observation::Note* first_cause() const;
};

/// Reads the file as far as it is intact. @throws recording::ReadError when it is no recording of this
/// version
[[nodiscard]] Review review(const std::filesystem::path& file);

/// What happened; the first sentence names the first cause.
[[nodiscard]] std::vector<std::string> sentences(const Review& review);
/// Commands that lead on.
[[nodiscard]] std::vector<std::string> next_commands(const Review& review);
[[nodiscard]] report::Page page_of(const Review& review);
/// The same with the curves of the page, thinned to at most `most_points` rows.
[[nodiscard]] nlohmann::ordered_json to_json(const Review& review, std::size_t most_points);

}  // namespace crane::review
