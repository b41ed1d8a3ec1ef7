#pragma once
/// Finds the fields of the topics by name ("state.swing_radial_rad"). The IDL text of this program or of a
/// recording defines the fields and their units. No I/O and no clock.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "crane/expression/expression.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "crane/recording/numbers.hpp"
#include "crane/recording/schema.hpp"

namespace crane::observation {

/// One topic whose samples have a Header.
struct TopicFields {
  std::string name;         ///< "crane/state"
  bool every_tick = false;  ///< true: one sample per tick
  recording::NumberReader reader;
  std::vector<recording::LeafType> leaves;
  std::size_t tick_leaf = 0, time_leaf = 0;  ///< header.tick, header.sample_time_ns
};

/// A field of a topic: one number.
struct Field {
  std::size_t topic = 0, leaf = 0;  ///< indices in FieldTable::topics() and TopicFields::leaves
};

class FieldTable {
 public:
  /// All topics of this program.
  FieldTable();
  /// Topics of a recording, with the types that the recording contains.
  explicit FieldTable(const recording::McapReader& recording);

  [[nodiscard]] const std::vector<TopicFields>& topics() const { return topics_; }
  /// @param name  "state.applied_v[0]" or "crane/state.applied_v[0]". @return nothing: no such field
  [[nodiscard]] std::optional<Field> find(std::string_view name) const;
  /// Explains why `name` is not a field, and names the most similar field.
  [[nodiscard]] std::string explain(std::string_view name) const;
  /// Symbol of the field in an expression; nothing for a text field.
  [[nodiscard]] std::optional<expression::Symbol> symbol_of(const Field& field) const;
  /// Symbol of an enumerator of any enumeration: "STATE_RUN".
  [[nodiscard]] std::optional<expression::Symbol> enumerator(std::string_view name) const;
  [[nodiscard]] std::string name_of(const Field& field) const;  ///< "state.applied_v[0]"
  [[nodiscard]] const recording::LeafType& leaf_of(const Field& field) const {
    return topics_[field.topic].leaves[field.leaf];
  }

 private:
  void add(std::string_view name, const recording::Schema& schema, std::string_view type);
  [[nodiscard]] const TopicFields* topic_of(std::string_view name) const;

  std::vector<TopicFields> topics_;
};

/// Assigns a column of TickRows to each field that an expression or a list of signals names.
class FieldSelection {
 public:
  explicit FieldSelection(const FieldTable& table) : table_{table} {}
  /// @return column of the field; a new field gets a new column
  /// @throws std::invalid_argument that explains why `name` is not a field
  std::size_t add(std::string_view name);
  /// Names for an expression: fields and enumerators. A field that is looked up gets a column. The vocabulary
  /// is valid while this object lives.
  [[nodiscard]] expression::Vocabulary vocabulary();
  [[nodiscard]] const std::vector<Field>& columns() const { return columns_; }

 private:
  std::size_t column_of(const Field& field);

  const FieldTable& table_;
  std::vector<Field> columns_;
};

}  // namespace crane::observation
