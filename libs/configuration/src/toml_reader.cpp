#include "crane/configuration/toml_reader.hpp"

#include <algorithm>
#include <limits>

#include "crane/configuration/rig.hpp"
#include "toml_document.hpp"
#include "toml_limits.hpp"

namespace crane::configuration {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kInexact = "must be a decimal number: integers beyond 2^53 are not exact";
constexpr int kNoInteger = std::numeric_limits<int>::min();

/// Moves nodes instead of copying them, because only a move preserves file and line of a node.
void move_lacking(toml::table& base, toml::table& into) {
  for (auto&& [key, node] : base) {
    toml::node* own = into.get(key.str());
    if (own == nullptr) {
      node.visit([&into, &key = key](auto& value) { into.insert(key, std::move(value)); });
    } else if (own->is_table() && node.is_table()) {
      move_lacking(*node.as_table(), *own->as_table());
    }
  }
}

std::string listed(const std::vector<std::string>& choices) {
  std::string text;
  for (const auto& choice : choices) text += (text.empty() ? "" : ", ") + choice;
  return text;
}

}  // namespace

TomlTable::TomlTable(const std::string& text, const std::string& file)
    : document_(std::make_shared<Document>()), place_(nullptr) {
  if (const auto excess = excess_of(text))
    throw ConfigurationError({file + ':' + std::to_string(excess->line) + ": " + excess->rule});
  try {
    document_->root = toml::parse(std::string_view(text), std::string_view(file));
  } catch (const toml::parse_error& error) {
    throw ConfigurationError({file + ':' + std::to_string(error.source().begin.line) +
                              ": syntax: " + std::string(error.description())});
  }
  document_->files = {file};
  Place& root = document_->places[""];
  root.table = &document_->root;
  root.file = file;
  place_ = &root;
}

TomlTable::TomlTable(std::shared_ptr<Document> document, Place* place)
    : document_(std::move(document)), place_(place) {}

void TomlTable::inherit(TomlTable base) {
  move_lacking(base.document_->root, document_->root);
  const auto& problems = base.document_->problems;
  document_->problems.insert(document_->problems.end(), problems.begin(), problems.end());
  document_->files.insert(document_->files.end(), base.document_->files.begin(), base.document_->files.end());
}

bool TomlTable::present() const { return place_->table != nullptr; }

bool TomlTable::has(std::string_view key) { return find(key, false).node != nullptr; }

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  if (!present()) return names;
  for (const auto& [key, node] : *place_->table) names.emplace_back(key.str());
  return names;
}

TomlTable::Value TomlTable::find(std::string_view key, bool required) {
  place_->known.emplace(key);
  const toml::node* node = present() ? place_->table->get(key) : nullptr;
  if (node == nullptr && required) place_->missing.emplace_back(key);
  return {node, place_, place_->name_of(key)};
}

double TomlTable::checked_number(const Value& value, std::string_view key, const Range& range) {
  if (!value.node->is_number()) {
    problem(key, "must be a number");
    return kNotANumber;
  }
  const auto number = value.node->value<double>();
  if (number && range.contains(*number)) return *number;
  problem(key, number ? range.rule() : kInexact);
  return kNotANumber;
}

double TomlTable::number(std::string_view key, const Range& range) {
  const Value value = find(key, true);
  return value.node == nullptr ? kNotANumber : checked_number(value, key, range);
}

double TomlTable::number(std::string_view key, const Range& range, double fallback) {
  const Value value = find(key, false);
  return value.node == nullptr ? fallback : checked_number(value, key, range);
}

int TomlTable::checked_integer(const Value& value, std::string_view key, int low, int high, int fallback) {
  const auto* integer = value.node->as_integer();
  if (integer != nullptr && integer->get() >= low && integer->get() <= high) {
    return static_cast<int>(integer->get());
  }
  problem(key, "must be an integer in [" + std::to_string(low) + ", " + std::to_string(high) + ']');
  return fallback;
}

int TomlTable::integer(std::string_view key, int low, int high) {
  const Value value = find(key, true);
  return value.node == nullptr ? kNoInteger : checked_integer(value, key, low, high, kNoInteger);
}

int TomlTable::integer(std::string_view key, int low, int high, int fallback) {
  const Value value = find(key, false);
  return value.node == nullptr ? fallback : checked_integer(value, key, low, high, fallback);
}

bool TomlTable::boolean(std::string_view key, bool fallback) {
  const Value value = find(key, false);
  if (value.node == nullptr) return fallback;
  if (const auto* boolean = value.node->as_boolean()) return boolean->get();
  problem(key, "must be true or false");
  return fallback;
}

std::string TomlTable::checked_text(const Value& value, std::string_view key) {
  if (const auto* text = value.node->as_string()) return text->get();
  problem(key, "must be a text in quotes");
  return {};
}

std::string TomlTable::text(std::string_view key) {
  const Value value = find(key, true);
  return value.node == nullptr ? std::string() : checked_text(value, key);
}

std::string TomlTable::text(std::string_view key, std::string_view fallback) {
  const Value value = find(key, false);
  return value.node == nullptr ? std::string(fallback) : checked_text(value, key);
}

std::string TomlTable::choice(std::string_view key, const std::vector<std::string>& choices) {
  const Value value = find(key, true);
  if (value.node == nullptr) return {};
  const auto* text = value.node->as_string();
  if (text != nullptr && std::find(choices.begin(), choices.end(), text->get()) != choices.end())
    return text->get();
  problem(key, "must be one of " + listed(choices));
  return {};
}

std::string TomlTable::choice(std::string_view key, const std::vector<std::string>& choices,
                              std::string_view fallback) {
  return has(key) ? choice(key, choices) : std::string(fallback);
}

std::vector<double> TomlTable::numbers(std::string_view key, const Range& range) {
  const Value value = find(key, false);
  if (value.node == nullptr) return {};
  const auto* array = value.node->as_array();
  std::vector<double> numbers;
  if (array == nullptr) problem(key, "must be an array of numbers");
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const toml::node& element = *array->get(i);
    const auto number = element.value<double>();
    const bool usable = number && element.is_number() && range.contains(*number);
    numbers.push_back(usable ? *number : kNotANumber);
    if (usable) continue;
    document_->report(&element, *place_,
                      value.name + '[' + std::to_string(i) + "] = " + written(element) + ": " +
                          (!element.is_number() ? "must be a number"
                           : number             ? range.rule()
                                                : kInexact));
  }
  return numbers;
}

std::vector<std::string> TomlTable::texts(std::string_view key) {
  const Value value = find(key, false);
  if (value.node == nullptr) return {};
  const auto* array = value.node->as_array();
  std::vector<std::string> texts;
  if (array == nullptr) problem(key, "must be an array of texts");
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const toml::node& element = *array->get(i);
    if (const auto* text = element.as_string()) {
      texts.push_back(text->get());
    } else {
      document_->report(
          &element, *place_,
          value.name + '[' + std::to_string(i) + "] = " + written(element) + ": must be a text in quotes");
    }
  }
  return texts;
}

TomlTable TomlTable::open(std::string_view key, bool required) {
  const Value value = find(key, required);
  if (value.node != nullptr && !value.node->is_table()) problem(key, "must be a table");
  return {document_, document_->place(value.name, value.node, *place_)};
}

TomlTable TomlTable::table(std::string_view key) { return open(key, false); }

TomlTable TomlTable::required_table(std::string_view key) { return open(key, true); }

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  const Value value = find(key, false);
  if (value.node == nullptr) return {};
  const auto* array = value.node->as_array();
  std::vector<TomlTable> tables;
  if (array == nullptr) problem(key, "must be an array of tables");
  for (std::size_t i = 0; array != nullptr && i < array->size(); ++i) {
    const toml::node* element = array->get(i);
    const std::string name = value.name + '[' + std::to_string(i) + ']';
    if (element->is_table()) {
      tables.push_back({document_, document_->place(name, element, *place_)});
    } else {
      document_->report(element, *place_, name + " = " + written(*element) + ": must be a table");
    }
  }
  return tables;
}

void TomlTable::ignore_unknown() {
  for (const auto& key : keys()) place_->known.insert(key);
}

void TomlTable::problem(std::string_view key, const std::string& rule) {
  const toml::node* node = present() ? place_->table->get(key) : nullptr;
  const std::string value = node == nullptr || node->is_table() ? "" : " = " + written(*node);
  document_->report(node, *place_, place_->name_of(key) + value + ": " + rule);
}

void TomlTable::problem(const std::string& rule) {
  document_->report(place_->table, *place_, (place_->path.empty() ? "" : place_->path + ": ") + rule);
}

std::string TomlTable::place(std::string_view key) const {
  const toml::node* node = present() ? place_->table->get(key) : nullptr;
  const bool located = node != nullptr && node->source().path != nullptr;
  return (located ? *node->source().path : place_->file) + ':' +
         std::to_string(located ? line_of(*node) : place_->line) + ": ";
}

void TomlTable::finish() {
  for (auto& [path, place] : document_->places) document_->report_unknown_and_missing(place);
  auto lines = document_->sorted_problems();
  if (!lines.empty()) throw ConfigurationError(std::move(lines));
}

}  // namespace crane::configuration
