#include "recorded_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "crane/bus/cdr.hpp"
#include "crane/recording/mcap_reader.hpp"

namespace crane::system_test {
namespace {

using campaign::Row;

constexpr std::size_t kEncapsulation_bytes = 4;
/// Half a step of a 12-bit converter of +-10 V.
constexpr double kConverterStep_v = 20.0 / 4096;
/// Longest time of a request until it acts, in ticks: a reliable writer repeats a lost one.
constexpr std::uint64_t kTakesEffect_ticks = 100;

template <class T>
bool decode(const topics::Topic<T>& topic, const recording::Message& message, T& out) {
  if (message.channel->topic != topic.description.name || message.data.size() < kEncapsulation_bytes)
    return false;
  return bus::CdrCodec::of(*topic.description.descriptor)
      .decode(message.data.subspan(kEncapsulation_bytes), false, &out);
}

/// Start-up number of the first writer from `known_ns` (clock of the writers) on. The order of arrival proves
/// nothing: the recorder may discover a restarted process later than the other processes do.
template <class Heard>
std::uint32_t first_writer_from(const std::vector<Heard>& heard, std::int64_t known_ns) {
  const Heard* first = nullptr;
  for (const auto& each : heard)
    if (each.written_ns >= known_ns && (first == nullptr || each.written_ns < first->written_ns))
      first = &each;
  return first == nullptr ? 0 : first->sample.header.epoch;
}

/// Newest sample of each tick that arrived until `until_ns`, of the writer `trusted` or of any writer.
template <class Heard>
auto by_tick(const std::vector<Heard>& heard, std::int64_t until_ns, std::optional<std::uint32_t> trusted) {
  std::map<std::uint64_t, decltype(Heard::sample)> result;
  for (const auto& [log_ns, written_ns, sample] : heard) {
    if (log_ns > until_ns) break;
    if (!trusted || sample.header.epoch == *trusted) result[sample.header.tick] = sample;
  }
  return result;
}

template <class Map>
typename Map::mapped_type newest(const Map& map, std::uint64_t tick) {
  const auto next = map.upper_bound(tick);
  return next == map.begin() ? typename Map::mapped_type{} : std::prev(next)->second;
}

/// Outputs of the bridge: the command that the state names, when the acting volts are those of this command.
void fill_outputs(Row& row, const std::map<std::uint64_t, msg::Command>& commands) {
  const auto found = commands.find(row.state.applied_command_tick);
  const bool latched = row.state.latch_reason != crane_LATCH_NONE;
  for (std::size_t i = 0; i < campaign::kAxes; ++i) {
    const double acts_v = row.state.applied_v[i];
    row.truth.converter_v[i] = row.truth.written_v[i] = acts_v;
    if (found == commands.end() || latched) continue;
    if (std::abs(acts_v - found->second.drive_v[i]) <= kConverterStep_v / 2)
      row.truth.written_v[i] = found->second.drive_v[i];
    row.truth.brake_release[i] = found->second.brake_release[i];
  }
}

void fill_truth(Row& row, const Row* before) {
  const auto& state = row.state;
  row.truth.position = {state.trolley_position_m, state.slew_angle_rad, state.cable_length_m};
  row.truth.swing_radial_rad = state.swing_radial_rad;
  row.truth.swing_tangential_rad = state.swing_tangential_rad;
  for (std::size_t i = 0; i < campaign::kAxes; ++i) {
    row.truth.brake_closed[i] = state.brake_closed[i];
    if (before != nullptr && row.time_ns > before->time_ns)
      row.truth.speed[i] = (row.truth.position[i] - before->truth.position[i]) * 1e9 /
                           static_cast<double>(row.time_ns - before->time_ns);
  }
}

}  // namespace

Recorded::Recorded(const std::filesystem::path& file) {
  recording::McapReader reader{file};
  reader.for_each({}, [this](const recording::Message& message) {
    Heard<msg::State> state{message.log_time_ns, message.publish_time_ns, {}};
    Heard<msg::Command> command{message.log_time_ns, message.publish_time_ns, {}};
    Heard<msg::SupervisorStatus> status{message.log_time_ns, message.publish_time_ns, {}};
    Heard<msg::Request> request{message.log_time_ns, message.publish_time_ns, {}};
    if (decode(topics::state, message, state.sample)) states_.push_back(state);
    if (decode(topics::command, message, command.sample)) commands_.push_back(command);
    if (decode(topics::supervisor, message, status.sample)) statuses_.push_back(status);
    if (decode(topics::request, message, request.sample)) requests_.push_back(request);
    return true;
  });
}

const Recorded::Heard<msg::State>* Recorded::first_state_from(std::int64_t monotonic_ns) const {
  const auto found = std::ranges::find_if(states_, [monotonic_ns](const auto& heard) {
    return heard.sample.header.sample_time_ns >= monotonic_ns;
  });
  return found == states_.end() ? nullptr : &*found;
}

/// The recorder takes one topic after the other: its order of arrival does not show which of two samples of
/// different topics was written first, but the times of their writers do.
std::uint64_t Recorded::first_tick_after(std::int64_t written_ns) const {
  std::int64_t nearest_ns = std::numeric_limits<std::int64_t>::max();
  std::uint64_t tick = std::numeric_limits<std::uint64_t>::max();
  for (const auto& status : statuses_)
    if (status.written_ns >= written_ns && status.written_ns < nearest_ns) {
      nearest_ns = status.written_ns;
      tick = status.sample.header.tick;
    }
  return tick;
}

std::vector<Row> Recorded::rows(std::int64_t from_ns, std::int64_t until_ns, bool nobody_else) const {
  const auto *begin = first_state_from(from_ns), *end = first_state_from(until_ns);
  if (begin == nullptr) return {};
  const auto until_log_ns = end == nullptr ? std::numeric_limits<std::int64_t>::max() : end->log_ns;
  const auto of_run = [&](const auto& heard) {
    return by_tick(heard, until_log_ns,
                   nobody_else ? std::nullopt : std::optional{first_writer_from(heard, begin->written_ns)});
  };
  const auto states = of_run(states_);
  const auto commands = of_run(commands_);
  const auto statuses = of_run(statuses_);
  std::vector<Row> rows;
  for (const auto& [tick, state] : states) {
    const auto time_ns = state.header.sample_time_ns;
    if (time_ns < from_ns || time_ns > until_ns) continue;
    Row row;
    row.time_ns = time_ns;
    row.state = state;
    row.command = newest(commands, tick);
    row.status = newest(statuses, tick);
    fill_truth(row, rows.empty() ? nullptr : &rows.back());
    fill_outputs(row, commands);
    rows.push_back(row);
  }
  for (const auto& request : requests_) {
    const auto first = first_tick_after(request.written_ns);
    for (Row& row : rows) {
      const auto tick = row.state.header.tick;
      if (tick < first || tick - first >= kTakesEffect_ticks) continue;
      row.reset_requested = row.reset_requested || request.sample.kind == crane_REQUEST_RESET;
      row.arm_requested = row.arm_requested || request.sample.kind == crane_REQUEST_ARM;
    }
  }
  return rows;
}

}  // namespace crane::system_test
