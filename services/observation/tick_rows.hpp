#pragma once
/// Joins the samples of several topics to rows: one row per tick of crane/state. Pure.
///
/// The fields of a topic that is written every tick are those of the row's tick; a sample that is missing
/// leaves NaN. The fields of the other topics keep their newest value. A row is complete when every selected
/// topic of the tick has arrived. The samples of one topic come in the order of ticks, as the bus delivers
/// them; therefore an incomplete row ends when a later row is complete, at the latest after kMostWaiting
/// ticks. Rows come in the order of ticks; a tick without crane/state has no row.
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
  static constexpr std::size_t kMostWaiting = 64;
  using Visit = std::function<void(const Row&)>;

  /// @param table    must live longer than this object
  /// @param columns  at most 64 topics
  /// @throws std::invalid_argument when the table has no crane/state
  TickRows(const FieldTable& table, std::vector<Field> columns, Visit visit);

  /// Topics whose samples are needed, as indices in FieldTable::topics(). crane/state is one of them.
  [[nodiscard]] const std::vector<std::size_t>& topics() const { return topics_; }

  /// @param payload  plain CDR with its encapsulation header. @throws recording::DecodeError
  void add(std::size_t topic, std::span<const std::uint8_t> payload);
  /// Visits the rows that still wait: the end of the data.
  void finish();

  [[nodiscard]] std::uint64_t late() const { return late_; }  ///< samples that arrived after their row

 private:
  struct Waiting {
    Row row;
    std::uint64_t arrived = 0;  ///< a bit for each of topics_
  };
  Waiting& waiting(std::uint64_t tick);
  void emit_first();

  const FieldTable& table_;
  std::vector<Field> columns_;
  Visit visit_;
  std::vector<std::size_t> topics_;
  std::size_t state_ = 0;        ///< index of crane/state
  std::uint64_t required_ = 0;   ///< bits of the topics that a complete row has
  std::vector<double> decoded_;  ///< values of one sample
  std::vector<double> held_;     ///< newest values of the topics without a tick, by column
  std::map<std::uint64_t, Waiting> waiting_;
  std::uint64_t newest_ = 0;  ///< tick of the last row
  bool begun_ = false;
  std::uint64_t late_ = 0;
};

}  // namespace crane::observation
