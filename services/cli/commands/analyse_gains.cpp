/// crane analyse gains: the gain curves of figures 3.5, 3.6 and 3.10, with the closed-loop poles.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "cli/commands/analyse.hpp"
#include "cli/text_table.hpp"
#include "crane/analysis/gain_curves.hpp"
#include "crane/configuration/extended_file.hpp"
#include "crane/configuration/output_files.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/plot/curves.hpp"
#include "crane/recording/csv.hpp"
#include "stack/data_files.hpp"

namespace crane::cli {
namespace {

using analysis::GainCurve;
using analysis::GainSample;

struct GainsOptions {
  std::string rig, out;
  bool json = false;
};

/// One figure of the source: its curve and its scales.
struct GainFigure {
  std::string figure, file, abscissa, x_label;
  std::string speed_name, swing_name;
  double scale = 1;  ///< divisor of K and of the swing gain in the picture
  GainCurve curve;
};

constexpr int kPoints = 91;

std::vector<GainFigure> figures_of(const GainsOptions& options) {
  plant::Parameters unloaded = analysis::figure_parameters(0), loaded = analysis::figure_parameters(0.5);
  double length_m = 1;
  if (!options.rig.empty()) {
    const auto rig = configuration::load_rig(stack::find_rig(options.rig));
    unloaded = loaded = rig.design.crane;
    length_m = rig.design.cable_length_m;
  }
  return {{"3.5", "figure_3_5", "cable_length_m", "L [m]", "K_xdot", "K_phi", 10,
           analysis::gains_over_cable_length(unloaded, kPoints)},
          {"3.6", "figure_3_6", "mass_ratio", "m_t", "K_xdot", "K_phi", 1,
           analysis::gains_over_mass_ratio(unloaded, length_m, kPoints)},
          {"3.10", "figure_3_10", "trolley_position_m", "x [m]", "K_gammadot", "K_theta", 1,
           analysis::gains_over_trolley_position(loaded, length_m, kPoints)}};
}

recording::Table table_of(const GainFigure& figure) {
  recording::Table table;
  const auto add = [&](std::string name, auto&& value) {
    recording::Table::Column column{std::move(name), {}};
    for (const GainSample& point : figure.curve) column.values.push_back(value(point));
    table.columns.push_back(std::move(column));
  };
  add(figure.abscissa, [](const GainSample& p) { return p.abscissa; });
  add("K", [](const GainSample& p) { return p.gains.position; });
  add(figure.speed_name, [](const GainSample& p) { return p.gains.speed; });
  add(figure.swing_name, [](const GainSample& p) { return p.gains.swing; });
  for (std::size_t i = 0; i < 4; ++i) {
    add("pole_" + std::to_string(i + 1) + "_re", [i](const GainSample& p) { return p.poles[i].real(); });
    add("pole_" + std::to_string(i + 1) + "_im", [i](const GainSample& p) { return p.poles[i].imag(); });
  }
  return table;
}

void draw(const std::filesystem::path& file, const GainFigure& figure) {
  const auto curve = [&](std::string name, double scale, auto&& value) {
    plot::NamedCurve named{scale == 1 ? name : name + "/" + recording::shortest(scale), {}, {}};
    for (const GainSample& point : figure.curve)
      named.points.push_back({point.abscissa, value(point) / scale});
    return named;
  };
  plot::draw_curves(
      file, "figure " + figure.figure + ": gains of partial-state feedback",
      {{figure.x_label,
        "gain",
        {curve("K", figure.scale, [](const GainSample& p) { return p.gains.position; }),
         curve(figure.speed_name, 1, [](const GainSample& p) { return p.gains.speed; }),
         curve(figure.swing_name, figure.scale, [](const GainSample& p) { return p.gains.swing; })}}});
}

/// Point of the curve that is nearest to `abscissa`.
const GainSample& nearest(const GainFigure& figure, double abscissa) {
  return *std::min_element(figure.curve.begin(), figure.curve.end(),
                           [abscissa](const GainSample& a, const GainSample& b) {
                             return std::abs(a.abscissa - abscissa) < std::abs(b.abscissa - abscissa);
                           });
}

void print(const GainFigure& figure) {
  std::cout << "figure " << figure.figure << '\n';
  TextTable table{{figure.abscissa, "K", figure.speed_name, figure.swing_name, "poles"}};
  const double low = figure.curve.front().abscissa, high = figure.curve.back().abscissa;
  for (int i = 0; i <= 4; ++i) {
    const GainSample& point = nearest(figure, low + (high - low) * i / 4);
    std::string poles;
    for (const auto& pole : point.poles)
      if (pole.imag() >= 0) poles += (poles.empty() ? "" : ", ") + pole_text(pole);
    table.add({fixed(point.abscissa, 3), fixed(point.gains.position, 4), fixed(point.gains.speed, 4),
               fixed(point.gains.swing, 4), poles});
  }
  table.print(std::cout);
  std::cout << '\n';
}

nlohmann::ordered_json figure_json(const GainFigure& figure) {
  nlohmann::ordered_json json{{"figure", figure.figure}, {"over", figure.abscissa}};
  for (const GainSample& point : figure.curve) {
    nlohmann::ordered_json poles;
    for (const auto& pole : point.poles) poles.push_back(pole_json(pole));
    json["points"].push_back({{figure.abscissa, point.abscissa},
                              {"K", point.gains.position},
                              {figure.speed_name, point.gains.speed},
                              {figure.swing_name, point.gains.swing},
                              {"poles", poles}});
  }
  return json;
}

int analyse_gains(const GainsOptions& options) {
  auto json = nlohmann::ordered_json::array();
  if (!options.out.empty()) require_directory(options.out);
  for (const auto& figure : figures_of(options)) {
    if (!options.out.empty()) {
      const auto file = std::filesystem::path{options.out} / figure.file;
      if (!options.rig.empty())
        configuration::require_other({file.string() + ".csv", file.string() + ".svg"},
                                     configuration::with_base_files({stack::find_rig(options.rig)}));
      recording::write_csv(file.string() + ".csv", table_of(figure));
      draw(file.string() + ".svg", figure);
    }
    json.push_back(figure_json(figure));
    if (!options.json) print(figure);
  }
  if (options.json) std::cout << json.dump(2) << '\n';
  return runtime::kExitDone;
}

}  // namespace

void add_analyse_gains(CLI::App& analyse, Action& chosen) {
  auto options = std::make_shared<GainsOptions>();
  auto* command = analyse.add_subcommand(
      "gains", "Compute gains and poles of gain scheduling over cable length, load and trolley position");
  command->add_option("--rig", options->rig,
                      "rig file or name; default: the parameters of the dissertation's figures");
  command->add_option("--out", options->out, "directory for figure_3_5, 3_6 and 3_10, each .csv and .svg");
  command->add_flag("--json", options->json, "print the curves as JSON");
  command->footer("Example: crane analyse gains --rig virginia_tech_tower --out out/gains");
  command->callback([options, &chosen] { chosen = [options] { return analyse_gains(*options); }; });
}

}  // namespace crane::cli
