#include "campaign/report.hpp"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "crane/bridge/last_line.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::campaign {
namespace {

bool failed(const Result& result) { return result.violations != 0 || result.crashed || !result.prepared; }

std::string violations_of(const Result& result) {
  if (result.crashed) return "the run crashed";
  if (!result.prepared) return "the crane did not come to this moment";
  std::string text;
  for (std::size_t i = 0; i < kInvariants; ++i)
    if (result.violations & (1U << i))
      text += (text.empty() ? "" : ", ") + std::string{name_of(static_cast<Invariant>(i))};
  return text + ": " + result.what;
}

std::string number(double value, const char* none = "–") {
  if (value < 0) return none;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.0f", value);
  return text.data();
}

}  // namespace

std::string to_string(const Reason& reason) {
  const std::string cause = supervisor::name_of(static_cast<supervisor::Cause>(reason.cause));
  if (reason.cause != crane_CAUSE_BRIDGE_LATCHED || reason.latch == crane_LATCH_NONE) return cause;
  return cause + ": " + std::string{bridge::name_of(static_cast<bridge::Reason>(reason.latch))};
}

std::string hazard_table() {
  std::string text = "| hazard | fault | tested by |\n|---|---|---|\n";
  for (const Hazard& hazard : hazards())
    text += "| " + std::to_string(hazard.number) + " | " + hazard.name + " | " +
            (hazard.test_bed == TestBed::campaign ? "campaign" : hazard.verified_by) + " |\n";
  return text;
}

std::string describe(const Result& result) {
  std::ostringstream text;
  text << to_string(result.tuple) << ": "
       << (result.stopped ? "stopped because of " + to_string(result.first) : std::string{"not stopped"});
  if (result.detection_ms >= 0)
    text << ", detected after " << result.detection_ms << " ms (bound " << result.bound_ms << ")";
  if (result.zero_volts_ms >= 0) text << ", 0 V after " << result.zero_volts_ms << " ms";
  if (result.braked_ms >= 0) text << ", braked after " << result.braked_ms << " ms";
  text << (failed(result) ? "\nVIOLATED " + violations_of(result) : std::string{"\nno violation"});
  return text.str();
}

std::string line_of(const Result& r) {
  std::ostringstream line;
  line << r.tuple.hazard << ' ' << name_of(r.tuple.moment) << ' ' << r.tuple.seed << ' ' << r.violations
       << ' ' << r.crashed << ' ' << r.prepared << ' ' << r.stopped << ' ' << r.right << ' ' << r.first.cause
       << ' ' << r.first.latch << ' ' << r.detection_ms << ' ' << r.zero_volts_ms << ' ' << r.braked_ms << ' '
       << r.bound_ms << ' ' << r.beyond_limit << ' ' << r.what;
  return line.str();
}

std::optional<Result> result_from(const std::string& line) {
  std::istringstream in{line};
  Result r;
  std::string moment, what;
  int cause = 0, latch = 0;
  in >> r.tuple.hazard >> moment >> r.tuple.seed >> r.violations >> r.crashed >> r.prepared >> r.stopped >>
      r.right >> cause >> latch >> r.detection_ms >> r.zero_volts_ms >> r.braked_ms >> r.bound_ms >>
      r.beyond_limit;
  const auto named = moment_named(moment);
  if (!in || !named || find_hazard(r.tuple.hazard) == nullptr) return std::nullopt;
  std::getline(in >> std::ws, what);
  what.copy(r.what, sizeof r.what - 1);
  r.tuple.moment = *named;
  r.first = {static_cast<crane_Cause>(cause), static_cast<crane_LatchReason>(latch)};
  return r;
}

void Table::add(const Result& result) {
  Line& line = lines_[result.tuple.hazard];
  ++line.runs;
  if (failed(result)) {
    ++line.failed;
    failed_.push_back(result);
  }
  if (result.right) ++line.right;
  if (!result.stopped) return;
  ++line.stopped;
  ++line.reasons[to_string(result.first)];
  if (result.detection_ms >= line.detection_ms)
    line.detection_ms = result.detection_ms, line.bound_ms = result.bound_ms;
  line.zero_volts_ms = std::max(line.zero_volts_ms, result.zero_volts_ms);
  line.braked_ms = std::max(line.braked_ms, result.braked_ms);
  line.beyond = std::max(line.beyond, result.beyond_limit);
}

std::string Table::text() const {
  std::ostringstream text;
  text << "| # | hazard | runs | violations | right first reason | stopped | worst detection (bound) ms | "
          "worst 0 V ms | worst "
          "braked ms | first reasons |\n|---|---|---|---|---|---|---|---|---|---|\n";
  std::size_t runs = 0, right = 0;
  for (const auto& [hazard, line] : lines_) {
    runs += line.runs, right += line.right;
    text << "| " << hazard << " | " << find_hazard(hazard)->name << " | " << line.runs << " | " << line.failed
         << " | " << 100.0 * static_cast<double>(line.right) / static_cast<double>(line.runs) << " % | "
         << line.stopped << " | " << number(line.detection_ms) << " (" << number(line.bound_ms) << ") | "
         << number(line.zero_volts_ms) << " | " << number(line.braked_ms) << " | ";
    for (const auto& [reason, count] : line.reasons) text << reason << " " << count << "; ";
    text << "|\n";
  }
  text << runs << " runs, " << failed_.size() << " with a violation, " << right
       << " with the right first reason\n";
  auto worst = failed_;
  std::ranges::sort(worst, {}, &Result::tuple);
  for (const auto& result : worst)
    text << to_string(result.tuple) << ": " << violations_of(result) << " ("
         << (result.stopped ? to_string(result.first) : "not stopped") << ", " << number(result.detection_ms)
         << " ms)\n";
  return text.str();
}

std::string Table::json() const {
  auto rows = nlohmann::ordered_json::array();
  for (const auto& [hazard, line] : lines_)
    rows.push_back({{"hazard", hazard},
                    {"name", find_hazard(hazard)->name},
                    {"runs", line.runs},
                    {"violations", line.failed},
                    {"right_first_reason", line.right},
                    {"stopped", line.stopped},
                    {"detection_ms", line.detection_ms},
                    {"bound_ms", line.bound_ms},
                    {"zero_volts_ms", line.zero_volts_ms},
                    {"braked_ms", line.braked_ms},
                    {"reasons", line.reasons}});
  auto failures = nlohmann::ordered_json::array();
  for (const auto& result : failed_)
    failures.push_back({{"tuple", to_string(result.tuple)}, {"what", violations_of(result)}});
  return nlohmann::ordered_json{{"hazards", rows}, {"violations", failures}}.dump(2) + "\n";
}

}  // namespace crane::campaign
