/// crane analyse damping: damping over the gain plane, as table, picture and summary. Equation numbers:
/// H. M. Omar, Control of Gantry and Tower Cranes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include "cli/commands/analyse.hpp"
#include "cli/text_table.hpp"
#include "crane/analysis/damping.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/plot/plane.hpp"
#include "crane/recording/csv.hpp"

namespace crane::cli {
namespace {

using analysis::AntiSwing;
using analysis::AntiSwingKind;
using analysis::Damping;
using analysis::DampingMap;
using analysis::GainPoint;
using analysis::GainRange;
using analysis::LoopDamping;
using analysis::Measure;

struct DampingOptions {
  std::vector<std::string> laws, ranges;
  int pade = 0;
  double tracking = 100, highest = 8;
  std::string out;
  bool json = false;
};

struct NamedPoint {
  std::string name;
  GainPoint gains;
  Damping damping;
};

struct DampingStudy {
  const AntiSwingKind* kind = nullptr;
  DampingMap map;
  std::optional<DampingMap> pade_map;
  std::vector<NamedPoint> points;
};

/// Parses "LOW:HIGH:POINTS".
GainRange range_of(const std::string& text) {
  GainRange range;
  char tail = '\0';
  const int read = std::sscanf(text.c_str(), "%lf:%lf:%d%c", &range.low, &range.high, &range.points, &tail);
  constexpr int kMostPoints = 1000;
  if (read != 3 || !std::isfinite(range.low) || !std::isfinite(range.high) || !(range.low < range.high) ||
      range.points < 3 || range.points > kMostPoints)
    throw configuration::ConfigurationError(
        {"--range " + text + ": must be LOW:HIGH:POINTS with LOW < HIGH and 3 to 1000 points"});
  return range;
}

LoopDamping damping_function(const DampingOptions& options, AntiSwing law, int pade) {
  const analysis::TrackingGains tracking{options.tracking, 2 * std::sqrt(options.tracking)};
  const double highest = options.highest * analysis::kHighestFrequency / 8;
  return [=](const GainPoint& gains) {
    const auto f = characteristic(law, gains, tracking);
    return pade > 0 ? pade_damping_of(f, pade, highest) : damping_of(f, highest);
  };
}

DampingStudy study_of(const DampingOptions& options, const AntiSwingKind& kind) {
  DampingStudy study;
  study.kind = &kind;
  const GainRange first = options.ranges.empty() ? kind.first : range_of(options.ranges[0]);
  const GainRange second = options.ranges.empty() ? kind.second : range_of(options.ranges[1]);
  if (kind.law != AntiSwing::pd && second.low < 0)
    throw configuration::ConfigurationError(
        {"--range " + options.ranges[1] + ": a delay must not be negative"});
  const auto exact = damping_function(options, kind.law, 0);
  study.map = damping_map(exact, first, second);
  study.points.push_back({"printed", kind.printed, exact(kind.printed)});
  if (options.pade > 0) {
    const auto pade = damping_function(options, kind.law, options.pade);
    study.pade_map = damping_map(pade, first, second);
    study.points.push_back(
        {"printed, Pade " + std::to_string(options.pade), kind.printed, pade(kind.printed)});
  }
  for (const auto& [name, measure] :
       {std::pair{"best dominant", Measure::dominant}, std::pair{"best least", Measure::least}}) {
    const auto best = optimum(exact, study.map, measure);
    study.points.push_back({name, best.gains, best.damping});
  }
  return study;
}

recording::Table table_of(const DampingStudy& study) {
  recording::Table table;
  const auto add = [&](std::string name, const DampingMap& map, auto&& value) {
    recording::Table::Column column{std::move(name), {}};
    for (int j = 0; j < map.second.points; ++j)
      for (int i = 0; i < map.first.points; ++i) column.values.push_back(value(i, j));
    table.columns.push_back(std::move(column));
  };
  const auto& map = study.map;
  const auto of = [](const DampingMap& m, double (*value)(const Damping&)) {
    return [&m, value](int i, int j) { return value(m.at(i, j)); };
  };
  add(std::string{study.kind->first_name}, map, [&](int i, int) { return map.first.at(i); });
  add(std::string{study.kind->second_name}, map, [&](int, int j) { return map.second.at(j); });
  add("dominant_damping", map, of(map, [](const Damping& d) { return d.dominant; }));
  add("least_damping", map, of(map, [](const Damping& d) { return d.least; }));
  add("right_most_re", map, of(map, [](const Damping& d) { return d.right_most; }));
  add("dominant_re", map, of(map, [](const Damping& d) { return d.dominant_root.real(); }));
  add("dominant_im", map, of(map, [](const Damping& d) { return d.dominant_root.imag(); }));
  add("least_re", map, of(map, [](const Damping& d) { return d.least_root.real(); }));
  add("least_im", map, of(map, [](const Damping& d) { return d.least_root.imag(); }));
  if (!study.pade_map) return table;
  const auto& pade = *study.pade_map;
  add("pade_dominant_damping", pade, of(pade, [](const Damping& d) { return d.dominant; }));
  add("pade_least_damping", pade, of(pade, [](const Damping& d) { return d.least; }));
  return table;
}

void draw(const std::filesystem::path& file, const DampingOptions& options, const DampingStudy& study) {
  const auto axis = [](std::string_view name, const GainRange& range) {
    return plot::PlaneAxis{std::string{name}, range.low, range.high, range.points};
  };
  const auto values = [&](Measure measure) {
    std::vector<double> result;
    for (const Damping& damping : study.map.values) result.push_back(merit(damping, measure));
    return result;
  };
  plot::Plane plane{.x = axis(study.kind->first_name, study.map.first),
                    .y = axis(study.kind->second_name, study.map.second),
                    .largest = 0.5,
                    .contour_step = 0.1,
                    .marks = {}};
  for (const auto& point : study.points)
    if (point.name.find("Pade") == std::string::npos)
      plane.marks.push_back({point.name, point.gains.first, point.gains.second});
  const std::string title = std::string{study.kind->name} + ", figure " + std::string{study.kind->figure} +
                            ", K_p = " + recording::shortest(options.tracking) +
                            ": damping ratio; blank: unstable";
  plot::draw_plane(file, title, plane,
                   {{"right-most pair", values(Measure::dominant)},
                    {"least damped of all pairs", values(Measure::least)}});
}

/// Largest difference of the damping over all points at which both loops are stable, and the gains of this
/// point.
std::string pade_difference(const DampingStudy& study) {
  double worst = 0;
  std::string where;
  for (int j = 0; j < study.map.second.points; ++j)
    for (int i = 0; i < study.map.first.points; ++i) {
      const Damping &exact = study.map.at(i, j), &pade = study.pade_map->at(i, j);
      const double difference = std::abs(exact.least - pade.least);
      if (exact.right_most >= 0 || pade.right_most >= 0 || difference <= worst) continue;
      worst = difference;
      where = " at (" + fixed(study.map.first.at(i), 4) + ", " + fixed(study.map.second.at(j), 4) + ")";
    }
  return "largest difference of the least damping between Pade and exact roots: " + fixed(worst, 4) + where;
}

void print(const DampingStudy& study) {
  const auto& kind = *study.kind;
  std::cout << kind.name << ", figure " << kind.figure
            << "; gains of the source (its signs): " << kind.printed_text
            << ", damping ratio read from the figure: " << fixed(kind.printed_damping, 2) << '\n';
  TextTable table{
      {"", std::string{kind.first_name}, std::string{kind.second_name}, "dominant", "pair", "least", "pair"}};
  for (const auto& point : study.points)
    table.add({point.name, fixed(point.gains.first, 4), fixed(point.gains.second, 4),
               fixed(point.damping.dominant, 4), pole_text(point.damping.dominant_root),
               fixed(point.damping.least, 4), pole_text(point.damping.least_root)});
  table.print(std::cout);
  if (study.pade_map) std::cout << pade_difference(study) << '\n';
  std::cout << '\n';
}

nlohmann::ordered_json study_json(const DampingOptions& options, const DampingStudy& study) {
  nlohmann::ordered_json json{{"law", study.kind->name},
                              {"figure", study.kind->figure},
                              {"tracking_proportional", options.tracking},
                              {"highest_load_frequencies", options.highest},
                              {"printed_damping", study.kind->printed_damping}};
  for (const auto& point : study.points)
    json["points"].push_back({{"name", point.name},
                              {std::string{study.kind->first_name}, point.gains.first},
                              {std::string{study.kind->second_name}, point.gains.second},
                              {"dominant_damping", point.damping.dominant},
                              {"dominant_pole", pole_json(point.damping.dominant_root)},
                              {"least_damping", point.damping.least},
                              {"least_pole", pole_json(point.damping.least_root)},
                              {"stable", point.damping.right_most < 0}});
  return json;
}

int analyse_damping(const DampingOptions& options) {
  if (!options.ranges.empty() && options.laws.size() != 1)
    throw configuration::ConfigurationError({"--range: needs exactly one law"});
  auto json = nlohmann::ordered_json::array();
  if (!options.out.empty()) require_directory(options.out);
  for (const auto& kind : analysis::kAntiSwingKinds) {
    if (!options.laws.empty() &&
        std::find(options.laws.begin(), options.laws.end(), kind.name) == options.laws.end())
      continue;
    const auto study = study_of(options, kind);
    if (!options.out.empty()) {
      const auto file = std::filesystem::path{options.out} / ("damping_" + std::string{kind.name});
      recording::write_csv(file.string() + ".csv", table_of(study));
      draw(file.string() + ".svg", options, study);
    }
    json.push_back(study_json(options, study));
    if (!options.json) print(study);
  }
  if (options.json) std::cout << json.dump(2) << '\n';
  return runtime::kExitDone;
}

}  // namespace

void add_analyse_damping(CLI::App& analyse, Action& chosen) {
  auto options = std::make_shared<DampingOptions>();
  auto* command = analyse.add_subcommand(
      "damping",
      "Compute the damping of tracking PD with a linear anti-swing law as a map over its two gains");
  std::vector<std::string> names;
  for (const auto& kind : analysis::kAntiSwingKinds) names.emplace_back(kind.name);
  command->add_option("law", options->laws, "pd, delayed_1, delayed_2; default: all")
      ->check(CLI::IsMember(names));
  command
      ->add_option("--pade", options->pade, "also compute with the Pade approximation (3.49) of this order")
      ->check(CLI::Range(1, 60));
  command->add_option("--range", options->ranges, "LOW:HIGH:POINTS of the first and of the second gain")
      ->expected(2)
      ->allow_extra_args(false);
  command->add_option("--tracking", options->tracking, "K_p of the tracking PD; K_d = 2 sqrt(K_p)")
      ->check(CLI::Range(0.01, 1e4))
      ->capture_default_str();
  command->add_option("--highest", options->highest, "ignore roots above this frequency, in load frequencies")
      ->check(CLI::Range(0.1, 100.0))
      ->capture_default_str();
  command->add_option("--out", options->out, "directory for damping_LAW.csv and damping_LAW.svg");
  command->add_flag("--json", options->json, "print the points as JSON");
  command->footer(
      "The roots are exact. Gains are for normalised time and the tower sign (docs/equations.md), so that\n"
      "K_ps and K_del are negative.\n"
      "Examples: crane analyse damping --pade 20 --out out/damping\n"
      "          crane analyse damping pd --range=-40:-10:61 4:12:61");
  command->callback([options, &chosen] { chosen = [options] { return analyse_damping(*options); }; });
}

}  // namespace crane::cli
