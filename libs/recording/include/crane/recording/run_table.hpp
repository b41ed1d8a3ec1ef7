#pragma once
/// Converts a run to a table: one row per crane/state, with the samples of other topics of the same tick.
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "crane/plant/coordinates.hpp"
#include "crane/plant/state.hpp"
#include "crane/recording/csv.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "crane/topics.hpp"

namespace crane::recording {

/// Accepts samples in any order. Columns: the canonical columns; tick; hoist_voltage_v; for each axis
/// trolley_/slew_/hoist_ …_reference_m|rad, …_control_v, …_friction_v; supervisor_state (number of the
/// SupervisorState in crane.idl). If a topic has no sample of a tick, its cells of this tick are NaN.
class RunTable {
 public:
  void add(const msg::State& sample);
  void add(const msg::Reference& sample);
  void add(const msg::Demand& sample);
  void add(const msg::SupervisorStatus& sample);

  /// time_s is the time since the first crane/state, or since `zero_time_ns`. A tick without crane/state has
  /// no row.
  [[nodiscard]] Table table() const;
  [[nodiscard]] Table table(std::int64_t zero_time_ns) const;

 private:
  static constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  static constexpr plant::PerAxis kNoAxis{kMissing, kMissing, kMissing};
  using Coordinates = std::array<double, plant::kCoordinates.size()>;
  /// The values of one tick that become cells.
  struct Row {
    std::optional<std::int64_t> sample_time_ns;  ///< nothing: no crane/state
    plant::PerAxis applied_v{};
    Coordinates measured{};  ///< by plant::CoordinateIndex
    plant::PerAxis reference = kNoAxis, control_v = kNoAxis, friction_v = kNoAxis;
    double supervisor_state = kMissing;
  };
  [[nodiscard]] Row& row(std::uint64_t tick);
  std::map<std::uint64_t, Row> rows_;
};

/// @return "366 ticks are missing, the first after tick 1058"; empty when none is missing or the table has no
///   column `tick`
[[nodiscard]] std::string missing_ticks(const Table& table);

/// Version of the messages in a recording: crane::MESSAGES_VERSION of its schema. Nothing: the recording has
/// no crane topics, or its schema defines no MESSAGES_VERSION.
[[nodiscard]] std::optional<std::uint32_t> messages_version(const McapReader& recording);

/// Difference between two versions of the messages; the texts of both always differ.
/// @param recorded  messages_version() of the recording
/// @return "messages of version 2, this program reads version 1"; empty when the versions are equal
[[nodiscard]] std::string version_difference(std::optional<std::uint32_t> recorded,
                                             std::uint32_t own = crane_MESSAGES_VERSION);

/// Table of a recorded run.
/// @throws DecodeError, SchemaError when the crane topics cannot be decoded
/// @throws SchemaError that names both versions when the messages have another version
[[nodiscard]] Table run_table(McapReader& recording);

}  // namespace crane::recording
