#include "crane/recording/csv.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <ostream>
#include <set>
#include <system_error>

#include "crane/fields/printable.hpp"
#include "crane/files/complete_file.hpp"
#include "date.hpp"

namespace crane::recording {
namespace {

/// Longest file that read_csv() takes: ten million rows of eight columns. The limit bounds the memory.
constexpr std::size_t kLongestCsv_bytes = std::size_t{1} << 30U;
/// Longest part of a name or cell in a message: in a file without commas, a whole line is one cell.
constexpr std::size_t kShown = 60;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t end = line.find(separator);
    cells.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

/// The most frequent separator of the header; the first of equally frequent ones.
char separator_of(std::string_view header) {
  constexpr std::string_view kSeparators = ",;\t";
  return *std::ranges::max_element(kSeparators, {}, [&](char c) { return std::ranges::count(header, c); });
}

/// The number that is the whole text.
std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

void require_writable(const Table& table) {
  std::set<std::string_view> names;
  for (const Table::Column& column : table.columns) {
    if (column.name.empty() || column.name.find_first_of(",\"\n\r") != std::string::npos)
      throw CsvError("column name \"" + column.name +
                     "\": must not be empty or contain a comma, quote or line end");
    if (!names.insert(column.name).second) throw CsvError("column " + column.name + " occurs twice");
    if (column.values.size() != table.rows())
      throw CsvError("column " + column.name + " has " + std::to_string(column.values.size()) + " rows, " +
                     table.columns.front().name + " has " + std::to_string(table.rows()));
  }
}

/// Parses the text line by line.
class Parser {
 public:
  Parser(std::string file, const std::vector<std::string>& wanted)
      : file_{std::move(file)}, wanted_{wanted} {}

  void line(std::string_view text) {
    ++line_;
    const std::string_view content = trimmed(text);
    if (content.empty() || content.front() == '#') return;
    if (table_.columns.empty()) {
      separator_ = separator_of(content);
      header(content);
    } else {
      row(text);
    }
  }

  Table take() {
    if (table_.columns.empty())
      throw CsvError(file_ + ":" + std::to_string(std::max(line_, 1)) + ": has no header line");
    if (wanted_.empty()) return std::move(table_);
    Table chosen;
    for (const std::string& name : wanted_)
      for (Table::Column& column : table_.columns)
        if (column.name == name) chosen.columns.push_back(std::move(column));
    return chosen;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw CsvError(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  void header(std::string_view text) {
    std::set<std::string_view> names;
    for (const std::string_view name : cells_of(text, separator_)) {
      if (name.empty()) fail("column " + std::to_string(names.size() + 1) + " has no name");
      if (!names.insert(name).second) fail("column " + fields::printable(name, kShown) + " occurs twice");
      table_.columns.push_back({std::string{name}, {}});
      kept_.push_back(wanted_.empty() || std::find(wanted_.begin(), wanted_.end(), name) != wanted_.end());
    }
  }

  void row(std::string_view text) {
    const std::vector<std::string_view> cells = cells_of(text, separator_);
    if (cells.size() != table_.columns.size())
      fail(std::to_string(cells.size()) + " cells, the header has " + std::to_string(table_.columns.size()));
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (kept_[i]) table_.columns[i].values.push_back(number(cells[i], table_.columns[i].name));
  }

  [[nodiscard]] double number(std::string_view cell, const std::string& column) const {
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    if (const auto value = number_in(cell)) return *value;
    if (const auto time_s = seconds_of_date(cell)) return *time_s;
    std::string with_point{cell};
    std::ranges::replace(with_point, ',', '.');
    if (const auto value = number_in(with_point)) return *value;
    fail(fields::printable(column, kShown) + " = \"" + fields::printable(cell, kShown) +
         "\": is not a number");
  }

  std::string file_;
  const std::vector<std::string>& wanted_;
  Table table_;
  std::vector<bool> kept_;
  char separator_ = ',';
  int line_ = 0;
};

}  // namespace

const std::vector<double>* Table::find(std::string_view name) const {
  for (const Column& column : columns)
    if (column.name == name) return &column.values;
  return nullptr;
}

void write_csv(std::ostream& out, const Table& table) {
  require_writable(table);
  std::string line;
  for (const Table::Column& column : table.columns) line += (line.empty() ? "" : ",") + column.name;
  out << line << '\n';
  for (std::size_t row = 0; row < table.rows(); ++row) {
    line.clear();
    for (const Table::Column& column : table.columns) {
      if (&column != &table.columns.front()) line += ',';
      line += shortest(column.values[row]);
    }
    line += '\n';
    out << line;
  }
}

void write_csv(const std::filesystem::path& file, const Table& table) {
  require_writable(table);
  files::write_file(file, [&table](std::ostream& out) { write_csv(out, table); });
}

Table parse_csv(std::string_view text, const std::string& file, const std::vector<std::string>& wanted) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  Parser parser{file, wanted};
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.line(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.take();
}

Table read_csv(const std::filesystem::path& file, const std::vector<std::string>& wanted) {
  errno = 0;
  std::ifstream in{file, std::ios::binary};
  std::string text;
  while (in && text.size() <= kLongestCsv_bytes) {
    constexpr std::size_t kPart_bytes = 1U << 20U;
    const auto before = text.size();
    text.resize(before + kPart_bytes);
    in.read(text.data() + before, kPart_bytes);
    text.resize(before + static_cast<std::size_t>(in.gcount()));
  }
  if (text.size() > kLongestCsv_bytes)
    throw CsvError(file.string() + ": is longer than " + std::to_string(kLongestCsv_bytes >> 20U) +
                   " MB: divide it");
  if (!in.eof() || in.bad())
    throw CsvError(file.string() + ": cannot read: " + std::generic_category().message(errno));
  return parse_csv(text, file.string(), wanted);
}

}  // namespace crane::recording
