#pragma once
/// A run as one table: samples of several topics joined by tick, one row per crane/state.
#include <cstdint>
#include <map>
#include <optional>

#include "crane/recording/csv.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "crane/topics.hpp"

namespace crane::recording {

/// Takes samples in any order. Columns: the canonical ones, then tick, hoist_voltage_v, per axis
/// trolley_/slew_/hoist_ …_reference_m|rad, …_control_v, …_friction_v, and supervisor_state (number of
/// SupervisorState in crane.idl). Where a topic had no sample of that tick, its cells are NaN.
class RunTable {
 public:
  void add(const msg::State& sample) { rows_[sample.header.tick].state = sample; }
  void add(const msg::Reference& sample) { rows_[sample.header.tick].reference = sample; }
  void add(const msg::Demand& sample) { rows_[sample.header.tick].demand = sample; }
  void add(const msg::SupervisorStatus& sample) { rows_[sample.header.tick].supervisor = sample; }

  /// time_s counts from the first crane/state, or from `zero_time_ns`. Ticks without a crane/state have no
  /// row.
  [[nodiscard]] Table table() const;
  [[nodiscard]] Table table(std::int64_t zero_time_ns) const;

 private:
  struct Row {
    std::optional<msg::State> state;
    std::optional<msg::Reference> reference;
    std::optional<msg::Demand> demand;
    std::optional<msg::SupervisorStatus> supervisor;
  };
  std::map<std::uint64_t, Row> rows_;
};

/// The run in a recording. @throws DecodeError, SchemaError when its crane topics cannot be read
[[nodiscard]] Table run_table(McapReader& recording);

}  // namespace crane::recording
