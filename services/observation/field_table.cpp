#include "observation/field_table.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "crane/fields/nearest_name.hpp"
#include "crane/topics.hpp"

namespace crane::observation {
namespace {

using recording::LeafType;
constexpr std::string_view kPrefix = "crane/";

std::string_view without_prefix(std::string_view name) {
  if (name.starts_with(kPrefix)) name.remove_prefix(kPrefix.size());
  return name;
}

std::optional<std::size_t> leaf_named(const std::vector<LeafType>& leaves, std::string_view name) {
  const auto found = std::ranges::find(leaves, name, &LeafType::name);
  if (found == leaves.end()) return std::nullopt;
  return static_cast<std::size_t>(found - leaves.begin());
}

bool is_every_tick(std::string_view name) {
  return std::ranges::any_of(topics::kAll, [&](const auto& t) { return t.name == name && t.every_tick; });
}

}  // namespace

FieldTable::FieldTable() {
  const recording::Schema schema{topics::idl_text()};
  for (const auto& topic : topics::kAll) add(topic.name, schema, topic.type);
}

FieldTable::FieldTable(const recording::McapReader& recording) {
  std::map<std::uint16_t, recording::Schema> schemas;
  for (const auto& channel : recording.channels()) {
    const auto* const record = recording.find_schema(channel.schema_id);
    if (record == nullptr || record->encoding != "omgidl" || !channel.topic.starts_with(kPrefix)) continue;
    const auto& schema = schemas.try_emplace(channel.schema_id, record->text).first->second;
    if (schema.contains(record->name)) add(channel.topic, schema, record->name);
  }
}

void FieldTable::add(std::string_view name, const recording::Schema& schema, std::string_view type) {
  auto leaves = schema.leaves(type);
  const auto tick = leaf_named(leaves, "header.tick"), time = leaf_named(leaves, "header.sample_time_ns");
  if (tick && time)
    topics_.push_back({.name = std::string{name},
                       .every_tick = is_every_tick(name),
                       .reader = schema.number_reader(type),
                       .leaves = std::move(leaves),
                       .tick_leaf = *tick,
                       .time_leaf = *time});
}

const TopicFields* FieldTable::topic_of(std::string_view name) const {
  const auto stem = name.substr(0, name.find('.'));
  const auto found = std::ranges::find_if(
      topics_, [&](const TopicFields& topic) { return without_prefix(topic.name) == stem; });
  return found == topics_.end() ? nullptr : &*found;
}

std::optional<Field> FieldTable::find(std::string_view name) const {
  name = without_prefix(name);
  const auto* const topic = topic_of(name);
  if (topic == nullptr || name.find('.') == std::string_view::npos) return std::nullopt;
  const auto leaf = leaf_named(topic->leaves, name.substr(name.find('.') + 1));
  if (!leaf) return std::nullopt;
  return Field{static_cast<std::size_t>(topic - topics_.data()), *leaf};
}

std::string FieldTable::explain(std::string_view name) const {
  const std::string quoted = "'" + std::string{name} + "'";
  name = without_prefix(name);
  if (const auto field = find(name)) return quoted + " is a text; an expression and a curve need numbers";
  const auto* const topic = topic_of(name);
  std::vector<std::string> known;
  if (topic == nullptr) {
    std::string all;
    for (const auto& each : topics_) {
      known.emplace_back(without_prefix(each.name));
      all += (all.empty() ? "" : ", ") + known.back();
    }
    const auto meant = fields::nearest_name(name.substr(0, name.find('.')), known);
    return "unknown name " + quoted + (meant.empty() ? "" : "; did you mean the topic " + meant + "?") +
           "; a field is written TOPIC.FIELD, and the topics are " + all;
  }
  const auto path =
      name.find('.') == std::string_view::npos ? std::string_view{} : name.substr(name.find('.') + 1);
  std::string below;
  for (const auto& leaf : topic->leaves) {
    known.push_back(leaf.name);
    const bool element = leaf.name.starts_with(path) && leaf.name.size() > path.size() &&
                         (path.empty() || leaf.name[path.size()] == '[' || leaf.name[path.size()] == '.');
    if (element) below += (below.empty() ? "" : ", ") + leaf.name;
  }
  if (!below.empty()) return quoted + " is not one number; choose one of " + below;
  const auto meant = fields::nearest_name(path, known);
  if (!meant.empty())
    return "unknown field " + quoted + "; did you mean " + std::string{without_prefix(topic->name)} + "." +
           meant + "?";
  std::string all;
  for (const auto& each : known) all += (all.empty() ? "" : ", ") + each;
  return "unknown field " + quoted + "; the fields of " + topic->name + " are " + all;
}

std::optional<expression::Symbol> FieldTable::symbol_of(const Field& field) const {
  const auto& leaf = leaf_of(field);
  expression::Symbol symbol;
  switch (leaf.kind) {
    case recording::Kind::string:
      return std::nullopt;
    case recording::Kind::boolean:
      symbol.type.kind = expression::Type::Kind::condition;
      break;
    case recording::Kind::enumeration:
      symbol.type = {.kind = expression::Type::Kind::enumeration, .enumeration = leaf.enumeration};
      break;
    default:
      if (const auto* const unit = fields::unit_with_symbol(leaf.unit)) {
        symbol.type.dimension = unit->dimension;
        symbol.factor = unit->factor;
      }
  }
  return symbol;
}

std::optional<expression::Symbol> FieldTable::enumerator(std::string_view name) const {
  for (const auto& topic : topics_)
    for (const auto& leaf : topic.leaves)
      if (const auto found = std::ranges::find(leaf.enumerators, name); found != leaf.enumerators.end())
        return expression::Symbol{
            .type = {.kind = expression::Type::Kind::enumeration, .enumeration = leaf.enumeration},
            .constant = true,
            .value = static_cast<double>(found - leaf.enumerators.begin())};
  return std::nullopt;
}

std::string FieldTable::name_of(const Field& field) const {
  return std::string{without_prefix(topics_[field.topic].name)} + "." + leaf_of(field).name;
}

std::size_t FieldSelection::column_of(const Field& field) {
  const auto found = std::ranges::find_if(
      columns_, [&](const Field& known) { return known.topic == field.topic && known.leaf == field.leaf; });
  if (found != columns_.end()) return static_cast<std::size_t>(found - columns_.begin());
  columns_.push_back(field);
  return columns_.size() - 1;
}

std::size_t FieldSelection::add(std::string_view name) {
  const auto field = table_.find(name);
  if (!field || !table_.symbol_of(*field)) throw std::invalid_argument(table_.explain(name));
  return column_of(*field);
}

expression::Vocabulary FieldSelection::vocabulary() {
  return {.find = [this](std::string_view name) -> std::optional<expression::Symbol> {
            const auto field = table_.find(name);
            if (!field) return table_.enumerator(name);
            auto symbol = table_.symbol_of(*field);
            if (symbol) symbol->column = column_of(*field);
            return symbol;
          },
          .explain = [this](std::string_view name) { return table_.explain(name); }};
}

}  // namespace crane::observation
