#include "crane/recording/columns.hpp"

#include <cstring>

#include "crane/fields/printable.hpp"
#include "leaf_walk.hpp"
#include "payload_cursor.hpp"

namespace crane::recording {
namespace {

/// "axis[1].position" -> "axis.position"
std::string without_indices(std::string_view leaf) {
  std::string name;
  bool inside = false;
  for (const char c : leaf) {
    if (c == '[') inside = true;
    if (!inside) name += c;
    if (c == ']') inside = false;
  }
  return name;
}

template <class Number>
void store(std::uint64_t raw, std::uint8_t* to) {
  const auto value = static_cast<Number>(raw);
  std::memcpy(to, &value, sizeof value);
}

void store(std::uint64_t raw, std::size_t bytes, std::uint8_t* to) {
  if (bytes == 1) return store<std::uint8_t>(raw, to);
  if (bytes == 2) return store<std::uint16_t>(raw, to);
  if (bytes == 4) return store<std::uint32_t>(raw, to);
  store<std::uint64_t>(raw, to);
}

}  // namespace

ColumnTable Schema::column_table(std::string_view type) const {
  const auto leaf_types = leaves(type);
  ColumnTable table;
  table.type_ = type;
  std::map<std::string, std::size_t> by_name;
  std::size_t leaf = 0;
  for_each_leaf(
      structure_named(*types_, type), [&](const std::string& name, const Field& field, std::uint32_t) {
        const auto& described = leaf_types[leaf++];
        const auto [entry, added] = by_name.try_emplace(without_indices(name), table.columns_.size());
        if (added) {
          Column column;
          column.name = entry->first;
          column.kind = field.kind;
          column.array = name != column.name;
          column.enumeration = described.enumeration;
          column.enumerators = described.enumerators;
          table.columns_.push_back(std::move(column));
        }
        auto& column = table.columns_[entry->second];
        table.elements_.push_back({entry->second, column.width++});
        column.units.push_back(described.unit);
      });
  return table;
}

std::size_t ColumnTable::bytes() const {
  std::size_t sum = rows_ * 2 * sizeof(std::int64_t);
  for (const auto& column : columns_) {
    sum += column.bytes.size();
    for (const auto& text : column.texts) sum += text.size();
  }
  return sum;
}

void ColumnTable::add(const Message& message) {
  PayloadCursor cursor{type_, message.data};
  for (auto& column : columns_) {
    if (column.kind == Kind::string)
      column.texts.resize((rows_ + 1) * column.width);
    else
      column.bytes.resize((rows_ + 1) * column.width * size_of(column.kind));
  }
  for (const auto& element : elements_) {
    auto& column = columns_[element.column];
    const auto cell = rows_ * column.width + element.index;
    if (column.kind == Kind::string) {
      auto text = cursor.text();
      if (text.ends_with('\0')) text.remove_suffix(1);
      column.texts[cell] = fields::printable(text);
    } else {
      const auto size = size_of(column.kind);
      store(cursor.raw(size), size, &column.bytes[cell * size]);
    }
  }
  cursor.finish();
  log_times_ns_.push_back(message.log_time_ns);
  publish_times_ns_.push_back(message.publish_time_ns);
  ++rows_;
}

void ColumnTable::clear_rows() {
  for (auto& column : columns_) {
    column.bytes.clear();
    column.texts.clear();
  }
  log_times_ns_.clear();
  publish_times_ns_.clear();
  rows_ = 0;
}

std::map<std::uint16_t, ColumnTable> column_tables(const McapReader& recording, const std::string& topic) {
  std::map<std::uint16_t, ColumnTable> tables;
  for (const auto& channel : recording.channels()) {
    const auto* schema = recording.find_schema(channel.schema_id);
    if (channel.message_encoding != "cdr" || schema == nullptr || schema->encoding != "omgidl") continue;
    if (!topic.empty() && channel.topic != topic) continue;
    tables.emplace(channel.id, Schema{schema->text}.column_table(schema->name));
  }
  return tables;
}

}  // namespace crane::recording
