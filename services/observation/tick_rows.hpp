#pragma once
/// Joins the samples of several topics to rows: one row per tick of crane/state. No I/O and no
/// clock.
///
/// A loop topic contributes the fields of the row's tick; if its sample is missing, the fields are NaN. Any
/// other topic contributes its newest values. A row is complete when the samples of all selected loop topics
/// have arrived. Rows are visited in the order of ticks. Because the bus delivers the samples of one topic in
/// the order of ticks, an incomplete row is visited when a later row is complete, or when more than
/// kMostWaiting rows wait. A tick without crane/state has no row.
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <vector>

#include "observation/field_table.hpp"

namespace crane::observation {

struct Row {
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;    ///< header.sample_time_ns of crane/state
  std::vector<double> values;  ///< by column, in the unit of the field
};

class TickRows {
 public:
  static constexpr std::size_t kMostWaiting = 64;  ///< incomplete rows
  using Visit = std::function<void(const Row&)>;

  /// @param table    must live longer than this object
  /// @param columns  at most 64 topics
  /// @throws std::invalid_argument when the table has no crane/state
  TickRows(const FieldTable& table, std::vector<Field> columns, Visit visit);

  /// Topics of the columns, and crane/state, as indices in FieldTable::topics().
  [[nodiscard]] const std::vector<std::size_t>& topics() const { return topics_; }

  /// Adds a sample. Samples of other topics have no effect.
  /// @param payload  plain CDR with its encapsulation header. @throws recording::DecodeError
  void add(std::size_t topic, std::span<const std::uint8_t> payload);
  /// Visits the incomplete rows. Call it at the end of the data.
  void finish();

  /// Number of samples that arrived after the visit of their row.
  [[nodiscard]] std::uint64_t late() const { return late_; }

 private:
  struct Waiting {
    Row row;
    std::uint64_t arrived = 0;  ///< bit i: the sample of topics_[i] has arrived
  };
  Waiting& waiting(std::uint64_t tick);
  void emit_first();

  const FieldTable& table_;
  std::vector<Field> columns_;
  Visit visit_;
  std::vector<std::size_t> topics_;
  std::size_t state_ = 0;        ///< index of crane/state
  std::uint64_t required_ = 0;   ///< `arrived` of a complete row
  std::vector<double> decoded_;  ///< values of one sample
  /// Newest values of the topics that are not written every tick, by column.
  std::vector<double> newest_values_;
  std::map<std::uint64_t, Waiting> waiting_;
  std::uint64_t newest_ = 0;  ///< tick of the last row
  bool begun_ = false;
  std::uint64_t late_ = 0;
};

}  // namespace crane::observation
