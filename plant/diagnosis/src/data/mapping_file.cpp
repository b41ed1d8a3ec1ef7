#include <algorithm>

#include "crane/configuration/toml_reader.hpp"
#include "crane/diagnosis/mapping.hpp"

namespace crane::diagnosis {
namespace {

using configuration::Range;
using configuration::TomlTable;

std::string canonical_names() {
  std::string names;
  for (const auto name : recording::kCanonicalColumns)
    names += (names.empty() ? "" : ", ") + std::string{name};
  return names;
}

/// Unit of a command: V, or the output of the amplifier per volt.
void read_unit(TomlTable& table, MappedColumn& mapped) {
  const bool command = mapped.canonical.ends_with("_voltage_v");
  if (!table.has("unit") && !table.has("per_volt")) return;
  if (!command) table.problem("unit", "is permitted for commands (..._voltage_v) only");
  mapped.unit = table.choice("unit", {"V", "A", "N m", "N"}, "V");
  const double per_volt = table.number("per_volt", Range::positive());
  if (table.has("factor")) table.problem("factor", "must not be given together with per_volt");
  mapped.factor = 1 / per_volt;
}

MappedColumn read_column(TomlTable table, const std::string& canonical) {
  MappedColumn mapped;
  mapped.canonical = canonical;
  if (table.has("value")) {
    mapped.offset = table.number("value", Range::any());
    if (canonical == "time_s") table.problem("value", "must not be given for time_s: time_s needs a column");
    return mapped;
  }
  mapped.column = table.text("column");
  if (table.has("column") && mapped.column.empty()) table.problem("column", "must not be empty");
  mapped.factor = table.number("factor", Range::positive(), mapped.factor);
  mapped.sign = table.integer("sign", -1, 1, mapped.sign);
  if (mapped.sign == 0) table.problem("sign", "must be 1 or -1");
  mapped.offset = table.number("offset", Range::any(), mapped.offset);
  if (canonical == "time_s" && mapped.sign == -1) table.problem("sign", "time must not run backwards");
  mapped.times = table.texts("times");
  if (std::any_of(mapped.times.begin(), mapped.times.end(), [](const auto& name) { return name.empty(); }))
    table.problem("times", "must name columns");
  if (table.has("wraps") && (canonical == "time_s" || canonical.ends_with("_voltage_v")))
    table.problem("wraps", "is permitted for positions and angles only");
  mapped.wraps = table.has("wraps") ? table.number("wraps", Range::positive()) : 0;
  read_unit(table, mapped);
  return mapped;
}

std::vector<MappedColumn> read_columns(TomlTable columns) {
  std::vector<MappedColumn> mapped;
  for (const std::string& name : columns.keys()) {
    const auto& known = recording::kCanonicalColumns;
    TomlTable table = columns.table(name);
    if (std::find(known.begin(), known.end(), name) != known.end()) {
      mapped.push_back(read_column(table, name));
    } else {
      columns.problem(name, "must be one of " + canonical_names());
      table.ignore_unknown();
    }
  }
  return mapped;
}

std::vector<Stretch> read_stretches(TomlTable& table, const std::string& file) {
  const std::vector<double> times = table.numbers(file, Range::any());
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i + 1 < times.size(); i += 2) stretches.push_back({times[i], times[i + 1]});
  const bool ordered = std::is_sorted(times.begin(), times.end());
  if (times.empty() || times.size() % 2 != 0 || !ordered)
    table.problem(file, "must be from, to, from, to ... in s, increasing");
  return stretches;
}

}  // namespace

Mapping parse_mapping(const std::string& text, const std::string& file) {
  TomlTable root(text, file);
  Mapping mapping;
  mapping.columns = read_columns(root.table("columns"));
  mapping.whole.from_s = root.number("from_s", Range::any(), mapping.whole.from_s);
  mapping.whole.to_s = root.number("to_s", Range::any(), mapping.whole.to_s);
  if (mapping.whole.from_s >= mapping.whole.to_s) root.problem("to_s", "must be after from_s");
  TomlTable enable = root.table("enable");
  if (enable.present()) {
    mapping.enable = enable.text("column");
    if (enable.has("column") && mapping.enable.empty()) enable.problem("column", "must not be empty");
  }
  TomlTable stretches = root.table("stretches");
  for (const std::string& name : stretches.keys()) mapping.stretches[name] = read_stretches(stretches, name);
  TomlTable runs = root.table("runs");
  for (const std::string& name : runs.keys()) {
    TomlTable run = runs.table(name);
    mapping.runs[name] = {run.number("cable_length_m", Range::positive(), 0),
                          run.number("load_mass_kg", Range::positive(), 0)};
  }
  root.finish();
  return mapping;
}

}  // namespace crane::diagnosis
