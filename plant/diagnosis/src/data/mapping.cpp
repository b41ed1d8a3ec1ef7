#include "crane/diagnosis/mapping.hpp"

#include <algorithm>

#include "crane/configuration/extended_file.hpp"
#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {
namespace {

using configuration::TomlTable;

std::string canonical_names() {
  std::string names;
  for (const auto name : recording::kCanonicalColumns)
    names += (names.empty() ? "" : ", ") + std::string{name};
  return names;
}

MappedColumn read_column(TomlTable table, const std::string& canonical) {
  MappedColumn mapped{.canonical = canonical, .column = table.text("column")};
  if (table.has("column") && mapped.column.empty()) table.problem("column", "must not be empty");
  mapped.factor = table.number("factor", configuration::Range::positive(), mapped.factor);
  mapped.sign = table.integer("sign", -1, 1, mapped.sign);
  if (mapped.sign == 0) table.problem("sign", "must be 1 or -1");
  mapped.offset = table.number("offset", configuration::Range::any(), mapped.offset);
  if (canonical == "time_s" && mapped.sign == -1) table.problem("sign", "time must not run backwards");
  return mapped;
}

std::vector<double> converted(std::vector<double> values, const MappedColumn& mapped) {
  for (double& value : values) value = mapped.sign * mapped.factor * value + mapped.offset;
  return values;
}

}  // namespace

Mapping load_mapping(const std::filesystem::path& file) {
  return parse_mapping(configuration::file_text(file), file.string());
}

Mapping parse_mapping(const std::string& text, const std::string& file) {
  TomlTable root(text, file);
  TomlTable columns = root.required_table("columns");
  Mapping mapping;
  for (const std::string& name : columns.keys()) {
    const auto& known = recording::kCanonicalColumns;
    const bool is_canonical = std::find(known.begin(), known.end(), name) != known.end();
    TomlTable table = columns.table(name);
    if (!is_canonical) {
      columns.problem(name, "must be one of " + canonical_names());
      table.ignore_unknown();
    } else {
      mapping.push_back(read_column(table, name));
    }
  }
  root.finish();
  return mapping;
}

recording::Table canonical(const recording::Table& table, const Mapping& mapping, const std::string& name) {
  std::vector<std::string> problems;
  recording::Table result;
  for (const auto column : recording::kCanonicalColumns) {
    const auto mapped = std::find_if(mapping.begin(), mapping.end(),
                                     [&](const MappedColumn& m) { return m.canonical == column; });
    const auto* values = table.find(mapped == mapping.end() ? column : std::string_view{mapped->column});
    if (values == nullptr && mapped != mapping.end())
      problems.push_back(name + ": " + mapped->column + ": missing: the mapping takes " +
                         std::string{column} + " from it");
    if (values == nullptr) continue;
    result.columns.push_back(
        {std::string{column}, mapped == mapping.end() ? *values : converted(*values, *mapped)});
  }
  if (!problems.empty()) throw DataError(problems);
  return result;
}

}  // namespace crane::diagnosis
