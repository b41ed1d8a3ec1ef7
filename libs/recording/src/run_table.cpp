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

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

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

void canonical_cells(RowWriter& row, const msg::State& state, double time_s) {
  row.cell("time_s", time_s);
  row.cell(kCoordinates[kTrolley].command_v, state.applied_v[kTrolley]);
  row.cell(kCoordinates[kSlew].command_v, state.applied_v[kSlew]);
  row.cell(kCoordinates[kTrolley].column, state.trolley_position_m);
  row.cell(kCoordinates[kSlew].column, state.slew_angle_rad);
  row.cell(kCoordinates[kSwingRadial].column, state.swing_radial_rad);
  row.cell(kCoordinates[kSwingTangential].column, state.swing_tangential_rad);
  row.cell(kCoordinates[kHoist].column, state.cable_length_m);
  row.cell("tick", static_cast<double>(state.header.tick));
  row.cell(kCoordinates[kHoist].command_v, state.applied_v[kHoist]);
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

/// Converts the state by its name, because the numbers of an older recording may differ.
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

Table RunTable::table() const {
  for (const auto& [tick, row] : rows_)
    if (row.state) return table(row.state->header.sample_time_ns);
  return table(0);
}

Table RunTable::table(std::int64_t zero_time_ns) const {
  const auto control_columns = columns_of_drives("_control_v"),
             friction_columns = columns_of_drives("_friction_v");
  Table result;
  RowWriter row{result};
  for (const auto& [tick, of] : rows_) {
    if (!of.state) continue;
    row.begin();
    canonical_cells(row, *of.state,
                    static_cast<double>(of.state->header.sample_time_ns - zero_time_ns) / 1e9);
    const auto reference = [&of = of](std::size_t axis) {
      return of.reference ? of.reference->axis[axis].position : kMissing;
    };
    for (std::size_t i = 0; i < kAxes; ++i) row.cell(kCoordinates[i].reference, reference(i));
    for (std::size_t i = 0; i < kAxes; ++i)
      row.cell(control_columns[i].c_str(), of.demand ? of.demand->control_v[i] : kMissing);
    for (std::size_t i = 0; i < kAxes; ++i)
      row.cell(friction_columns[i].c_str(), of.demand ? of.demand->friction_v[i] : kMissing);
    row.cell("supervisor_state", of.supervisor ? static_cast<double>(of.supervisor->state) : kMissing);
  }
  return result;
}

std::optional<std::uint32_t> messages_version(const McapReader& recording) {
  for (const auto& channel : recording.channels()) {
    const SchemaRecord* record = recording.find_schema(channel.schema_id);
    if (record != nullptr && record->encoding == "omgidl" && record->name.starts_with("crane::"))
      return Schema{record->text}.constant("crane::MESSAGES_VERSION");
  }
  return std::nullopt;
}

Table run_table(McapReader& recording) {
  const auto version = messages_version(recording);
  if (version.value_or(crane_MESSAGES_VERSION) != crane_MESSAGES_VERSION)
    throw SchemaError("the recording has messages of version " + std::to_string(*version) +
                      ", this program reads version " + std::to_string(crane_MESSAGES_VERSION) +
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
