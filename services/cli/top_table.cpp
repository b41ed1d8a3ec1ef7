#include "cli/top_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ranges>
#include <sstream>

#include "cli/snapshot.hpp"
#include "cli/text_table.hpp"
#include "crane/fields/angle.hpp"

namespace crane::cli {
namespace {

using fields::kDegPerRad;
using observation::Spread, observation::Traffic;

constexpr std::size_t kUnlimited = 100'000;

/// A table whose columns have an importance. Columns with the importance 0 are omitted first.
class RankedTable {
 public:
  struct Column {
    std::string title;
    int importance = 0;
  };
  explicit RankedTable(std::vector<Column> columns) : columns_{std::move(columns)} {}
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }

  [[nodiscard]] std::string text(std::size_t width) const {
    for (int least = 0;; ++least) {
      auto text = with_importance(least);
      const bool more = std::ranges::any_of(columns_, [&](const Column& c) { return c.importance > least; });
      if (!more || widest(text) <= width) return text;
    }
  }

 private:
  [[nodiscard]] std::vector<std::string> chosen(int least, const std::vector<std::string>& row) const {
    std::vector<std::string> cells;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i].importance >= least) cells.push_back(row[i]);
    return cells;
  }
  [[nodiscard]] std::string with_importance(int least) const {
    std::vector<std::string> titles;
    for (const auto& column : columns_) titles.push_back(column.title);
    TextTable table{chosen(least, titles)};
    for (const auto& row : rows_) table.add(chosen(least, row));
    std::ostringstream out;
    table.print(out);
    return out.str();
  }
  static std::size_t widest(const std::string& text) {
    std::size_t most = 0;
    std::istringstream lines{text};
    for (std::string line; std::getline(lines, line);) most = std::max(most, width_of(line));
    return most;
  }

  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

std::string or_dash(const std::optional<double>& value, int digits) {
  return value ? fixed(*value, digits) : "-";
}

std::string head(const TopModel& model, const std::string& title, std::int64_t now_ns,
                 std::int64_t log_now_ns) {
  std::ostringstream out;
  out << title;
  if (model.state()) out << "  tick " << model.state()->header.tick;
  out << '\n';
  if (const auto age_ns = model.age_ns(now_ns); age_ns > observation::kStale_ns)
    out << "OLD         no sample for " << fixed(static_cast<double>(age_ns) * 1e-9, 0)
        << " s: the crane may be in another state; see crane doctor\n";
  if (model.supervisor())
    print_supervisor(out, *model.supervisor());
  else
    out << "supervisor  no status received\n";
  if (model.state()) {
    print_latch(out, *model.state());
    const auto& state = *model.state();
    const auto swing = [&](const char* name, double now_rad, const TopModel::Swing& largest) {
      out << name << fixed(now_rad * kDegPerRad, 2) << " deg (largest "
          << fixed(std::abs(largest.angle_rad) * kDegPerRad, 2) << " at tick " << largest.tick << ")";
    };
    swing("swing       radial ", state.swing_radial_rad, model.radial());
    swing("  tangential ", state.swing_tangential_rad, model.tangential());
    out << '\n';
  }
  if (const auto& faults = model.faults().faults(); !faults.empty()) {
    const auto& first = faults.back().notes.front();
    out << "last " << (first.kind == observation::Note::Kind::fault ? "fault  " : "stop   ") << " "
        << fixed(static_cast<double>(log_now_ns - first.at_ns) * 1e-9, 0) << " s ago: " << first.from << ' '
        << first.what << ": " << first.explanation << '\n';
  }
  return out.str();
}

RankedTable processes(const TopModel& model, std::int64_t now_ns) {
  RankedTable table{{{"process", 9},
                     {"vendor", 3},
                     {"pid", 4},
                     {"phase", 8},
                     {"ticks/s", 9},
                     {"lost", 7},
                     {"late", 6},
                     {"rejected", 1},
                     {"step mean us", 2},
                     {"max us", 5}}};
  for (const auto& heard : model.traffic().nodes() | std::views::values) {
    const auto& node = heard.status;
    table.add({node.name, node.vendor, std::to_string(node.pid),
               heard.silent(now_ns) ? "silent" : observation::phase_name(node.phase),
               or_dash(heard.tick_rate_hz, 1), std::to_string(node.lost_ticks),
               std::to_string(node.late_samples), std::to_string(node.rejected_samples),
               fixed(node.step_mean_us, 1), fixed(node.step_max_us, 1)});
  }
  return table;
}

/// Shown topics: all, those with samples, loop topics with samples.
enum class Shown : std::uint8_t { all, heard, loop };

RankedTable topics_of(const TopModel& model, bool with_trends, Shown shown) {
  std::vector<RankedTable::Column> columns{{"topic", 9}, {"rate Hz", 9},      {"lost", 8},   {"late", 4},
                                           {"dup", 2},   {"delay p50 us", 3}, {"p99 us", 7}, {"max us", 6}};
  if (with_trends) columns.push_back({"delay p99 (else rate), last 30 s", 5});
  RankedTable table{columns};
  for (std::size_t i = 0; i < topics::kAll.size(); ++i) {
    const auto& topic = model.traffic().topic(i);
    if (topic.counts.samples == 0 && shown != Shown::all) continue;
    if (!topics::kAll[i].every_tick && shown == Shown::loop) continue;
    const bool counted = topics::kAll[i].every_tick && topic.counts.samples > 0;
    const auto count = [counted](std::uint64_t n) { return counted ? std::to_string(n) : std::string{"-"}; };
    const auto delay = [&topic](double Spread::*share) {
      return topic.delay_us ? fixed((*topic.delay_us).*share, 0) : std::string{"-"};
    };
    const bool flows = topic.window.samples > 0;
    std::vector<std::string> row{std::string{topics::kAll[i].name},
                                 flows ? or_dash(topic.window.rate_hz, 1) : "0",
                                 count(topic.counts.lost),
                                 count(topic.counts.late),
                                 count(topic.counts.duplicate),
                                 delay(&Spread::p50),
                                 delay(&Spread::p99),
                                 delay(&Spread::max)};
    if (with_trends) row.push_back(sparkline(model.trend(i)));
    table.add(std::move(row));
  }
  return table;
}

}  // namespace

std::string sparkline(const std::deque<double>& values) {
  constexpr std::array kBlocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  const double most = values.empty() ? 0 : *std::ranges::max_element(values);
  std::string line;
  for (const double value : values) {
    const double share = most > 0 ? std::clamp(value / most, 0.0, 1.0) : 0;
    line += kBlocks[static_cast<std::size_t>(std::lround(share * (kBlocks.size() - 1)))];
  }
  return line;
}

std::string top_text(const TopModel& model, const TopView& view, std::int64_t now_ns,
                     std::int64_t log_now_ns) {
  const auto width = view.size ? static_cast<std::size_t>(view.size->columns) : kUnlimited;
  std::string text;
  for (const auto shown : {Shown::all, Shown::heard, Shown::loop}) {
    text = head(model, view.title, now_ns, log_now_ns) + '\n' + processes(model, now_ns).text(width) + '\n' +
           topics_of(model, view.trends, shown).text(width);
    if (!view.size || std::ranges::count(text, '\n') <= view.size->rows) break;
  }
  return text;
}

}  // namespace crane::cli
