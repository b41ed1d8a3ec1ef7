/// Tables of the score: targets, power against amplitude, confusions.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <sstream>

#include "score/score_record.hpp"

namespace crane::diagnosis::score {
namespace {

using Records = std::vector<Record>;
using Is = std::function<bool(const Record&)>;

Records only(const Records& all, const Is& is) {
  Records some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some), is);
  return some;
}

/// Selects the sets whose effects reach the detection limit.
Records of_kind(const Records& all, Kind kind) {
  return only(all, [&](const Record& r) {
    return r.kind == name_of(kind) && r.judged != "no data" && (kind == Kind::clean || r.multiple > 0);
  });
}

bool is(const Record& r, std::initializer_list<Judged> any) {
  return std::any_of(any.begin(), any.end(), [&](Judged judged) { return r.judged == name_of(judged); });
}

std::size_t count(const Records& some, std::initializer_list<Judged> any) {
  return static_cast<std::size_t>(
      std::count_if(some.begin(), some.end(), [&](const Record& r) { return is(r, any); }));
}

double quantile(std::vector<double> values, double at) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(at * static_cast<double>(values.size() - 1))];
}

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(digits);
  text << value;
  return text.str();
}

class Targets {
 public:
  void row(const std::string& measure, const std::string& target, const std::string& measured) {
    text_ << "| " << measure << " | " << target << " | " << measured << " |\n";
  }
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

void add_naming(const Records& all, Targets& table) {
  const Records singles = of_kind(all, Kind::single);
  for (const double multiple : {8.0, 4.0, 2.0, 1.0}) {
    const Records at = only(singles, [&](const Record& r) { return r.multiple == multiple; });
    if (at.empty()) continue;
    const std::string times = " at " + rounded(multiple, 0) + " ×";
    table.row("named exactly" + times, "≥ 90 %", share(count(at, {Judged::right}), at.size()));
    table.row("named up to a confounded group" + times, "≥ 95 %",
              share(count(at, {Judged::right, Judged::among, Judged::group}), at.size()));
    table.row("another cause named with confidence" + times, "–",
              share(count(at, {Judged::wrong}), at.size()));
  }
}

void add_rest(const Records& all, Targets& table) {
  const Records clean = of_kind(all, Kind::clean), outside = of_kind(all, Kind::outside);
  const Records pairs = of_kind(all, Kind::pair), alike = of_kind(all, Kind::confounded);
  table.row("no answer: crash, time limit, refusal", "0",
            share(static_cast<std::size_t>(std::count_if(
                      all.begin(), all.end(), [](const Record& r) { return r.judged == "failed"; })),
                  all.size()));
  table.row("sets with causes below the detection limit, not judged", "–",
            std::to_string(std::count_if(all.begin(), all.end(), [](const Record& r) {
              return r.kind != name_of(Kind::clean) && r.judged != "no data" && r.multiple == 0;
            })));
  table.row("false alarms on clean data", "≤ 2 %",
            share(clean.size() - count(clean, {Judged::right}), clean.size()));
  table.row("outside the library: \"unknown\"", "≥ 90 %",
            share(count(outside, {Judged::right}), outside.size()));
  table.row("outside the library: falsely named", "≤ 5 %",
            share(count(outside, {Judged::wrong}), outside.size()));
  table.row("two causes: both", "≥ 85 %", share(count(pairs, {Judged::right, Judged::beside}), pairs.size()));
  table.row("two causes: both up to a confounded group", "–",
            share(count(pairs, {Judged::right, Judged::beside, Judged::group}), pairs.size()));
  table.row("two causes: at least one up to a confounded group", "≥ 97 %",
            share(count(pairs, {Judged::right, Judged::beside, Judged::group, Judged::partly, Judged::among}),
                  pairs.size()));
  table.row("confounded: ambiguous or right", "≥ 95 %",
            share(count(alike, {Judged::right, Judged::among}), alike.size()));
  const Records tried = only(all, [](const Record& r) { return !r.resolved.empty(); });
  const auto solved = std::count_if(tried.begin(), tried.end(),
                                    [](const Record& r) { return r.resolved == name_of(Judged::right); });
  table.row("ambiguous: the proposed run decides", "≥ 90 %",
            share(static_cast<std::size_t>(solved), tried.size()));
}

/// Coverage of the intervals.
struct Coverage {
  explicit Coverage(const std::vector<Compared>& estimates) {
    for (const Compared& one : estimates) {
      inside += one.inside() ? 1 : 0;
      either += one.inside() || one.within_5pc() ? 1 : 0;
      if (one.truth != 0) errors.push_back(std::abs(one.estimate / one.truth - 1));
    }
  }
  std::size_t inside = 0, either = 0;
  std::vector<double> errors;  ///< relative
};

void add_numbers(const Records& all, Targets& table) {
  std::vector<double> gains, times, memory;
  std::vector<Compared> estimates;
  for (const Record& r : all) {
    if (r.judged == "no data") continue;
    times.push_back(r.runtime_s);
    memory.push_back(r.peak_mb);
    const bool named = is(r, {Judged::right, Judged::beside});
    if (r.oracle && named && r.oracle_gain > 0.02) gains.push_back(r.gain / r.oracle_gain);
    if (!named) continue;
    estimates.insert(estimates.end(), r.estimates.begin(), r.estimates.end());
  }
  table.row("held-out gain against an oracle's, median", "≥ 90 %",
            rounded(100 * quantile(gains, 0.5), 0) + " % of " + std::to_string(gains.size()) + " named sets");
  table.row("true value inside the 95 % interval", "93–97 %",
            share(Coverage(estimates).inside, estimates.size()));
  table.row("within 5 % or inside", "–", share(Coverage(estimates).either, estimates.size()));
  table.row("run time, median / 95 % / longest", "≤ 60 s",
            rounded(quantile(times, 0.5), 0) + " / " + rounded(quantile(times, 0.95), 0) + " / " +
                rounded(quantile(times, 1), 0) + " s");
  table.row("peak memory", "≤ 500 MB", rounded(quantile(memory, 1), 0) + " MB");
}

std::string power(const Records& all) {
  std::map<std::string, std::map<double, Records>> by_cause;
  for (const Record& r : of_kind(all, Kind::single))
    by_cause[r.causes.empty() ? r.judged : r.causes[0]][r.multiple].push_back(r);
  std::ostringstream text;
  text << "| cause | 1 × | 2 × | 4 × | 8 × |\n|---|---|---|---|---|\n";
  for (const auto& [cause, by_multiple] : by_cause) {
    text << "| `" << cause << "` |";
    for (const double multiple : {1.0, 2.0, 4.0, 8.0}) {
      const auto found = by_multiple.find(multiple);
      text << ' ';
      if (found == by_multiple.end())
        text << "–";
      else
        text << count(found->second, {Judged::right}) << " of " << found->second.size();
      text << " |";
    }
    text << '\n';
  }
  return text.str();
}

/// By parameter, of named causes.
std::string accuracy(const Records& all) {
  std::map<std::string, std::vector<Compared>> by_parameter;
  for (const Record& r : all)
    for (const Compared& one : r.estimates)
      if (is(r, {Judged::right, Judged::beside}))
        by_parameter[one.cause + " " + one.parameter].push_back(one);
  std::ostringstream text;
  text << "| parameter | inside the 95 % interval | inside or within 5 % | median error "
          "|\n|---|---|---|---|\n";
  for (const auto& [name, estimates] : by_parameter) {
    const Coverage coverage(estimates);
    const std::string of = " of " + std::to_string(estimates.size());
    text << "| `" << name << "` | " << coverage.inside << of << " | " << coverage.either << of << " | "
         << rounded(100 * quantile(coverage.errors, 0.5), 1) << " % |\n";
  }
  return text.str();
}

/// Confusions: hidden and named.
std::string mistaken(const Records& all) {
  std::map<std::string, std::map<std::string, int>> said;
  for (const Record& r : all) {
    if (r.judged == "no data" || r.judged == name_of(Judged::right)) continue;
    const std::string found = r.found.empty() || r.verdict == "unknown" ? r.verdict : r.found;
    ++said[r.hidden.empty() ? "nothing" : r.hidden][r.verdict == "ambiguous" ? "ambiguous: " + found : found];
  }
  std::ostringstream text;
  for (const auto& [hidden, answers] : said) {
    text << hidden << ":";
    for (const auto& [found, times] : answers) text << ' ' << times << " × " << found << ';';
    text << '\n';
  }
  return text.str();
}

}  // namespace

std::string share(std::size_t hits, std::size_t of) {
  if (of == 0) return "none scored";
  const double n = static_cast<double>(of), p = static_cast<double>(hits) / n, z = 1.96;
  const double middle = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  std::ostringstream text;
  text << hits << " of " << of << ", " << std::lround(100 * p) << " % ["
       << std::lround(100 * std::max(0.0, middle - half)) << ", "
       << std::lround(100 * std::min(1.0, middle + half)) << "]";
  return text.str();
}

std::string table_of(const std::vector<Record>& records, bool quiet) {
  Targets table;
  add_naming(records, table);
  add_rest(records, table);
  add_numbers(records, table);
  const auto without = only(records, [](const Record& r) { return r.judged == "no data"; });
  std::ostringstream text;
  text << records.size() << " sets, " << without.size()
       << " of them without data (the crane left its range)\n\n"
       << "| measure | target | measured |\n|---|---|---|\n"
       << table.text() << "\nNamed exactly, against the amplitude in detection limits\n\n"
       << power(records) << "\nEstimates of causes named\n\n"
       << accuracy(records) << quarters_of(records);
  if (!quiet) text << "\nHidden, and said where it was not that alone\n\n" << mistaken(records);
  return text.str();
}

}  // namespace crane::diagnosis::score
