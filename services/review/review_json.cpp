/// A review for programs and for the dashboard.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "crane/supervisor/states.hpp"
#include "review/review.hpp"

namespace crane::review {
namespace {

using nlohmann::ordered_json;

double seconds_since_begin(const Review& review, std::int64_t at_ns) {
  return static_cast<double>(at_ns - review.begin_ns) * 1e-9;
}

ordered_json note_json(const Review& review, const observation::Note& note) {
  return {{"at_s", seconds_since_begin(review, note.at_ns)},
          {"tick", note.tick},
          {"from", note.from},
          {"what", note.what},
          {"explanation", note.explanation},
          {"remedy", note.remedy}};
}

/// Every n-th value, so that at most `most` are left; NaN is null.
ordered_json thinned(const std::vector<double>& values, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, (values.size() + most - 1) / most);
  auto list = ordered_json::array();
  for (std::size_t i = 0; i < values.size(); i += step)
    list.push_back(std::isfinite(values[i]) ? ordered_json(values[i]) : ordered_json(nullptr));
  return list;
}

ordered_json curves_json(const Curves& curves, std::size_t most) {
  return {{"time_s", thinned(curves.time_s, most)},
          {"trolley_m", thinned(curves.position[0], most)},
          {"slew_deg", thinned(curves.position[1], most)},
          {"cable_m", thinned(curves.position[2], most)},
          {"trolley_reference_m", thinned(curves.reference[0], most)},
          {"slew_reference_deg", thinned(curves.reference[1], most)},
          {"trolley_v", thinned(curves.volts[0], most)},
          {"slew_v", thinned(curves.volts[1], most)},
          {"swing_radial_deg", thinned(curves.radial_deg, most)},
          {"swing_tangential_deg", thinned(curves.tangential_deg, most)}};
}

}  // namespace

ordered_json to_json(const Review& review, std::size_t most_points) {
  const auto* cause = review.first_cause();
  ordered_json json{{"file", std::filesystem::path{review.file}.filename().string()},
                    {"duration_s", seconds_since_begin(review, review.end_ns)},
                    {"sentences", sentences(review)},
                    {"next_commands", next_commands(review)},
                    {"first_cause", cause == nullptr ? ordered_json(nullptr) : note_json(review, *cause)},
                    {"states", ordered_json::array()},
                    {"largest_swing_radial_deg", review.largest_radial_deg},
                    {"largest_swing_tangential_deg", review.largest_tangential_deg},
                    {"axes", ordered_json::array()},
                    {"problems", review.problems},
                    {"curves", curves_json(review.curves, most_points)}};
  for (const auto& phase : review.phases)
    json["states"].push_back({{"at_s", seconds_since_begin(review, phase.at_ns)},
                              {"state", supervisor::name_of(static_cast<supervisor::State>(phase.state))}});
  for (const auto& axis : review.axes)
    json["axes"].push_back({{"largest_speed", axis.largest_speed},
                            {"largest_error", axis.largest_error},
                            {"largest_v", axis.largest_volts},
                            {"saturated_s", axis.saturated_s}});
  return json;
}

}  // namespace crane::review
