#include "crane/diagnosis/mapping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/configuration/extended_file.hpp"
#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {
namespace {

using Values = std::vector<double>;

/// Adds multiples of the range, so that no value differs from the one before by more than half the range.
void unwrap(double range, Values& values) {
  double last = std::numeric_limits<double>::quiet_NaN();
  for (double& value : values) {
    if (!std::isfinite(value)) continue;
    if (std::isfinite(last)) value += range * std::round((last - value) / range);
    last = value;
  }
}

/// Canonical table of one file.
class Mapped {
 public:
  Mapped(const recording::Table& table, const Mapping& mapping, const std::string& name)
      : table_(table),
        mapping_(mapping),
        name_(name),
        short_name_(std::filesystem::path{name}.filename().string()) {}

  recording::Table run() {
    for (const auto column : recording::kCanonicalColumns) add(std::string{column});
    add_values();
    std::vector<double> enabled(table_.rows(), 1.0);
    if (!mapping_.enable.empty()) enabled = source(mapping_.enable, "the rows that count");
    if (!problems_.empty()) throw DataError(problems_);
    select(enabled);
    return std::move(result_);
  }

 private:
  void add(const std::string& canonical) {
    const auto& columns = mapping_.columns;
    const auto mapped = std::find_if(columns.begin(), columns.end(),
                                     [&](const MappedColumn& m) { return m.canonical == canonical; });
    if (mapped == columns.end()) {
      if (const Values* values = table_.find(canonical)) result_.columns.push_back({canonical, *values});
      return;
    }
    Values values(table_.rows(), mapped->column.empty() ? 0.0 : 1.0);
    if (!mapped->column.empty()) values = source(mapped->column, canonical);
    for (const std::string& other : mapped->times) {
      const Values by = source(other, canonical);
      for (std::size_t k = 0; k < std::min(values.size(), by.size()); ++k) values[k] *= by[k];
    }
    for (double& value : values) value = mapped->sign * mapped->factor * value + mapped->offset;
    if (mapped->wraps > 0) unwrap(mapped->wraps, values);
    result_.columns.push_back({canonical, std::move(values)});
  }

  /// Constants of the run replace columns.
  void add_values() {
    const auto found = mapping_.runs.find(short_name_);
    if (found == mapping_.runs.end()) return;
    const auto put = [&](const std::string& column, double value) {
      if (!(value > 0)) return;
      std::erase_if(result_.columns, [&](const auto& c) { return c.name == column; });
      result_.columns.push_back({column, Values(table_.rows(), value)});
    };
    put("cable_length_m", found->second.cable_length_m);
    put(kLoadMassColumn, found->second.load_mass_kg);
  }

  Values source(const std::string& column, const std::string& what) {
    if (const Values* values = table_.find(column)) return *values;
    const std::string problem = name_ + ": " + column + ": missing: the mapping takes " + what + " from it";
    if (std::find(problems_.begin(), problems_.end(), problem) == problems_.end())
      problems_.push_back(problem);
    return Values(table_.rows(), 0.0);
  }

  /// Number of the stretch of every row; 0: the row does not count.
  [[nodiscard]] Values stretches_of(const Values& enabled) const {
    const Values* time_s = result_.find("time_s");
    const auto own = mapping_.stretches.find(short_name_);
    const std::vector<Stretch> all =
        own == mapping_.stretches.end() ? std::vector<Stretch>{Stretch{}} : own->second;
    Values numbers(table_.rows(), 0.0);
    double number = 0;
    std::size_t last = all.size();
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      std::size_t in = all.size();
      for (std::size_t i = 0; i < all.size() && in == all.size(); ++i)
        if (time_s == nullptr || inside(all[i], (*time_s)[k])) in = i;
      const bool counts = enabled[k] != 0 && std::isfinite(enabled[k]) &&
                          (time_s == nullptr || inside(mapping_.whole, (*time_s)[k]));
      if (!counts) in = all.size();
      if (in != all.size() && in != last) ++number;
      if (in != all.size()) numbers[k] = number;
      last = in;
    }
    return numbers;
  }
  /// A NaN counts as inside; a later check reports it.
  static bool inside(const Stretch& stretch, double time_s) {
    return !(time_s < stretch.from_s) && !(time_s > stretch.to_s);
  }

  void select(const Values& enabled) {
    const Values numbers = stretches_of(enabled);
    const bool all = std::all_of(numbers.begin(), numbers.end(), [](double n) { return n == 1; });
    if (all) return;
    result_.columns.push_back({kStretchColumn, numbers});
    for (auto& column : result_.columns) {
      Values kept;
      for (std::size_t k = 0; k < numbers.size(); ++k)
        if (numbers[k] > 0) kept.push_back(column.values[k]);
      column.values = std::move(kept);
    }
  }

  const recording::Table& table_;
  const Mapping& mapping_;
  const std::string& name_;
  std::string short_name_;
  recording::Table result_;
  std::vector<std::string> problems_;
};

}  // namespace

Mapping load_mapping(const std::filesystem::path& file) {
  return parse_mapping(configuration::file_text(file), file.string());
}

recording::Table canonical(const recording::Table& table, const Mapping& mapping, const std::string& name) {
  return Mapped(table, mapping, name).run();
}

}  // namespace crane::diagnosis
