#include "crane/recording/run_table.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "crane/plant/coordinates.hpp"
#include "crane/recording/schema.hpp"

namespace crane::recording {
namespace {

using nlohmann::ordered_json;
using plant::kAxes, plant::kCoordinates, plant::kTrolley, plant::kSlew, plant::kHoist, plant::kSwingRadial,
    plant::kSwingTangential;

/// Builds a table row by row; columns are found by name.
class RowWriter {
 public:
  explicit RowWriter(Table& table) : table_{table} {}
  void begin() { next_ = 0; }
  void cell(const char* name, double value) {
    if (next_ == table_.columns.size()) table_.columns.push_back({name, {}});
    table_.columns[next_++].values.push_back(value);
  }

 private:
  Table& table_;
  std::size_t next_ = 0;
};

/// "trolley_control_v", ...
std::array<std::string, kAxes> columns_of_drives(const char* quantity) {
  std::array<std::string, kAxes> columns;
  for (std::size_t i = 0; i < kAxes; ++i) columns[i] = std::string{kCoordinates[i].name} + quantity;
  return columns;
}

void canonical_cells(RowWriter& row, double time_s, std::uint64_t tick, const plant::PerAxis& applied_v,
                     std::span<const double> measured) {
  row.cell("time_s", time_s);
  row.cell(kCoordinates[kTrolley].command_v, applied_v[kTrolley]);
  row.cell(kCoordinates[kSlew].command_v, applied_v[kSlew]);
  row.cell(kCoordinates[kTrolley].column, measured[kTrolley]);
  row.cell(kCoordinates[kSlew].column, measured[kSlew]);
  row.cell(kCoordinates[kSwingRadial].column, measured[kSwingRadial]);
  row.cell(kCoordinates[kSwingTangential].column, measured[kSwingTangential]);
  row.cell(kCoordinates[kHoist].column, measured[kHoist]);
  row.cell("tick", static_cast<double>(tick));
  row.cell(kCoordinates[kHoist].command_v, applied_v[kHoist]);
}

msg::State state_from(const ordered_json& j) {
  msg::State state{};
  state.header.tick = j.at("header").at("tick");
  state.header.sample_time_ns = j.at("header").at("sample_time_ns");
  state.trolley_position_m = j.at("trolley_position_m");
  state.slew_angle_rad = j.at("slew_angle_rad");
  state.cable_length_m = j.at("cable_length_m");
  state.swing_radial_rad = j.at("swing_radial_rad");
  state.swing_tangential_rad = j.at("swing_tangential_rad");
  for (std::size_t i = 0; i < kAxes; ++i) state.applied_v[i] = j.at("applied_v").at(i);
  return state;
}

msg::Reference reference_from(const ordered_json& j) {
  msg::Reference reference{};
  reference.header.tick = j.at("header").at("tick");
  for (std::size_t i = 0; i < kAxes; ++i) reference.axis[i].position = j.at("axis").at(i).at("position");
  return reference;
}

msg::Demand demand_from(const ordered_json& j) {
  msg::Demand demand{};
  demand.header.tick = j.at("header").at("tick");
  for (std::size_t i = 0; i < kAxes; ++i) {
    demand.control_v[i] = j.at("control_v").at(i);
    demand.friction_v[i] = j.at("friction_v").at(i);
  }
  return demand;
}

/// Converts the state by its name, because its number may differ in an older recording.
msg::SupervisorStatus supervisor_from(const ordered_json& j) {
  static constexpr std::array kNames{
#define CRANE_STATE(name, text) "STATE_" text,
#include "crane/states.def"
#undef CRANE_STATE
  };
  msg::SupervisorStatus status{};
  status.header.tick = j.at("header").at("tick");
  const auto* const found = std::find(kNames.begin(), kNames.end(), j.at("state").get<std::string>());
  if (found == kNames.end())
    throw DecodeError("crane/supervisor.state: " + j.at("state").dump() + " is not known");
  status.state = static_cast<crane_SupervisorState>(found - kNames.begin());
  return status;
}

void add_message(RunTable& run, const std::string& topic, const ordered_json& sample) {
  if (topic == topics::state.description.name) run.add(state_from(sample));
  if (topic == topics::reference.description.name) run.add(reference_from(sample));
  if (topic == topics::demand.description.name) run.add(demand_from(sample));
  if (topic == topics::supervisor.description.name) run.add(supervisor_from(sample));
}

}  // namespace

RunTable::Row& RunTable::row(std::uint64_t tick) {
  if (!rows_.empty() && rows_.rbegin()->first == tick) return rows_.rbegin()->second;
  return rows_[tick];
}

void RunTable::add(const msg::State& sample) {
  Row& of = row(sample.header.tick);
  of.sample_time_ns = sample.header.sample_time_ns;
  std::copy_n(sample.applied_v, kAxes, of.applied_v.begin());
  of.measured[kTrolley] = sample.trolley_position_m;
  of.measured[kSlew] = sample.slew_angle_rad;
  of.measured[kHoist] = sample.cable_length_m;
  of.measured[kSwingRadial] = sample.swing_radial_rad;
  of.measured[kSwingTangential] = sample.swing_tangential_rad;
}
void RunTable::add(const msg::Reference& sample) {
  Row& of = row(sample.header.tick);
  for (std::size_t i = 0; i < kAxes; ++i) of.reference[i] = sample.axis[i].position;
}
void RunTable::add(const msg::Demand& sample) {
  Row& of = row(sample.header.tick);
  std::copy_n(sample.control_v, kAxes, of.control_v.begin());
  std::copy_n(sample.friction_v, kAxes, of.friction_v.begin());
}
void RunTable::add(const msg::SupervisorStatus& sample) {
  row(sample.header.tick).supervisor_state = static_cast<double>(sample.state);
}

Table RunTable::table() const {
  for (const auto& [tick, row] : rows_)
    if (row.sample_time_ns) return table(*row.sample_time_ns);
  return table(0);
}

Table RunTable::table(std::int64_t zero_time_ns) const {
  const auto control_columns = columns_of_drives("_control_v"),
             friction_columns = columns_of_drives("_friction_v");
  Table result;
  RowWriter row{result};
  for (const auto& [tick, of] : rows_) {
    if (!of.sample_time_ns) continue;
    row.begin();
    canonical_cells(row, static_cast<double>(*of.sample_time_ns - zero_time_ns) / 1e9, tick, of.applied_v,
                    of.measured);
    for (std::size_t i = 0; i < kAxes; ++i) row.cell(kCoordinates[i].reference, of.reference[i]);
    for (std::size_t i = 0; i < kAxes; ++i) row.cell(control_columns[i].c_str(), of.control_v[i]);
    for (std::size_t i = 0; i < kAxes; ++i) row.cell(friction_columns[i].c_str(), of.friction_v[i]);
    row.cell("supervisor_state", of.supervisor_state);
  }
  return result;
}

std::string missing_ticks(const Table& table) {
  const auto* ticks = table.find("tick");
  if (ticks == nullptr) return {};
  double missing = 0, first_after = 0;
  for (std::size_t k = 1; k < ticks->size(); ++k) {
    const double skipped = (*ticks)[k] - (*ticks)[k - 1] - 1;
    if (skipped > 0 && missing == 0) first_after = (*ticks)[k - 1];
    missing += skipped;
  }
  if (missing == 0) return {};
  return shortest(missing) +
         (missing == 1 ? " tick is missing, after tick " : " ticks are missing, the first after tick ") +
         shortest(first_after);
}

std::optional<std::uint32_t> messages_version(const McapReader& recording) {
  for (const auto& channel : recording.channels()) {
    const SchemaRecord* record = recording.find_schema(channel.schema_id);
    if (record != nullptr && record->encoding == "omgidl" && record->name.starts_with("crane::"))
      return Schema{record->text}.constant("crane::MESSAGES_VERSION");
  }
  return std::nullopt;
}

std::string version_difference(std::optional<std::uint32_t> recorded, std::uint32_t own) {
  if (recorded == own) return {};
  const std::string program = ", this program reads version " + std::to_string(own);
  if (!recorded)
    return "messages without a version (their schema has no readable MESSAGES_VERSION)" + program;
  return "messages of version " + std::to_string(*recorded) + program;
}

Table run_table(McapReader& recording) {
  const auto version = messages_version(recording);
  const auto difference = version_difference(version);
  if (version && !difference.empty())
    throw SchemaError("the recording has " + difference +
                      ": make the table with the release that recorded it, or decode single topics with "
                      "`crane log export --topic`");
  RunTable run;
  std::map<std::uint16_t, Schema> schemas;
  Selection selection;
  for (const topics::Description* topic : {&topics::state.description, &topics::reference.description,
                                           &topics::demand.description, &topics::supervisor.description})
    selection.topics.emplace_back(topic->name);
  recording.for_each(selection, [&](const Message& message) {
    const std::uint16_t id = message.channel->schema_id;
    const SchemaRecord* record = recording.find_schema(id);
    if (record == nullptr) throw SchemaError(message.channel->topic + " has no schema");
    const Schema& schema = schemas.try_emplace(id, record->text).first->second;
    try {
      add_message(run, message.channel->topic, schema.decode(record->name, message.data));
    } catch (const ordered_json::exception& error) {
      throw DecodeError(message.channel->topic + ": " + error.what());
    }
    return true;
  });
  return run.table();
}

}  // namespace crane::recording
