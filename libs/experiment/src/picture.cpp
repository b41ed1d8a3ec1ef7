#include "crane/experiment/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "crane/fields/angle.hpp"
#include "crane/plot/gnuplot.hpp"

namespace crane::experiment {
namespace {

using plot::quoted;
using recording::shortest;

using fields::kDegPerRad;
constexpr double kWidth = 900, kPanelHeight = 215, kTop = 62, kBottom = 58;  // pixels

// Colours of Okabe and Ito, distinguishable with colour blindness and in grey.
constexpr const char* kBlue = "#0072B2";
constexpr const char* kOrange = "#D55E00";
constexpr const char* kGreen = "#009E73";
constexpr const char* kGrey = "#707070";

/// Columns of the data block.
enum Column : int {
  kTime = 1,
  kTrolley,
  kTrolleyRef,
  kSlew,
  kSlewRef,
  kHoist,
  kHoistRef,
  kRadial,
  kTangential,
  kTrolleyV,
  kSlewV,
  kHoistV
};

struct Curve {
  int column;
  const char* name;
  const char* colour;
  const char* style;  ///< gnuplot line style
};

struct Panel {
  std::string label;
  std::vector<Curve> curves;
  double smallest_half_range = 0;  ///< minimum half height of the y range
  double band = 0;                 ///< half height of a grey band around 0
};

double in(double value, double scale) {
  return std::round(value * scale * 1e6) / 1e6;
}  // fewer points keep the file small

std::string data_block(std::span<const Sample> run, double zero_s) {
  std::string text = "$run << END\n";
  for (const Sample& s : run) {
    if (s.time_s < zero_s) continue;
    const auto cell = [&text](double value, double scale = 1) { text += shortest(in(value, scale)) + " "; };
    cell(s.time_s - zero_s);
    constexpr plant::PerAxis kScale{1, kDegPerRad, 1};
    for (std::size_t axis = 0; axis < plant::kAxes; ++axis) {
      cell(s.position[axis], kScale[axis]);
      cell(s.reference[axis], kScale[axis]);
    }
    cell(s.swing_radial_rad, kDegPerRad);
    cell(s.swing_tangential_rad, kDegPerRad);
    for (const double volts : s.drive_v) cell(volts);
    text += "\n";
  }
  return text + "END\n";
}

std::vector<Panel> panels_of(const Maneuver& maneuver) {
  constexpr const char* kSolid = "lw 1.8 dt 1";
  constexpr const char* kDashed = "lw 1.4 dt (8,5)";
  const auto position = [=](std::string label, int column, const char* colour, double half_range) {
    return Panel{std::move(label),
                 {{column + 1, "reference", kGrey, kDashed}, {column, "measured", colour, kSolid}},
                 half_range};
  };
  const bool hoisting = maneuver.to[plant::kHoist] != maneuver.from[plant::kHoist];
  std::vector<Panel> panels{position("trolley [m]", kTrolley, kBlue, 0.05),
                            position("slew [deg]", kSlew, kOrange, 5)};
  if (hoisting) panels.push_back(position("cable [m]", kHoist, kGreen, 0.05));
  panels.push_back({"swing [deg]",
                    {{kRadial, "radial", kBlue, kSolid}, {kTangential, "tangential", kOrange, kSolid}},
                    1,
                    kSettlingSwing_rad * kDegPerRad});
  panels.push_back(
      {"drive [V]", {{kTrolleyV, "trolley", kBlue, kSolid}, {kSlewV, "slew", kOrange, kSolid}}, 1});
  if (hoisting) panels.back().curves.push_back({kHoistV, "hoist", kGreen, kSolid});
  return panels;
}

std::string settled_text(const Metrics& metrics) {
  if (!metrics.settling_time_s) return "not settled";
  return "settled after " + shortest(std::round(*metrics.settling_time_s * 100) / 100) + " s";
}

/// gnuplot settings of all panels: frame, grid, captions, mark of the settling time.
std::string settings(const Caption& caption, const Maneuver& maneuver, const Metrics& metrics, double end_s,
                     double height) {
  const auto pixel_y = [height](double from_top) { return shortest(1 - from_top / height); };
  std::string text;
  text += "set datafile missing 'nan'\nset encoding utf8\nunset title\n";
  text += "set border 3 lw 0.8 lc rgb '#404040'\nset tics nomirror out scale 0.5 textcolor rgb '#202020'\n";
  text += "set grid xtics ytics lt 1 lw 0.5 lc rgb '#dcdcdc'\nset grid back\n";
  text += "set key top right horizontal samplen 2.2 spacing 1.1 opaque fillcolor rgb '#ffffff' noenhanced\n";
  text +=
      "set xrange [0:" + shortest(end_s) + "]\nset lmargin at screen 0.095\nset rmargin at screen 0.975\n";
  text += "set label 1 " + quoted(caption.scenario + "  –  " + caption.controller) + " at screen 0.095," +
          pixel_y(22) + " left noenhanced font ',16' textcolor rgb '#101010'\n";
  text += "set label 2 " + quoted(caption.rig + ", " + settled_text(metrics)) + " at screen 0.095," +
          pixel_y(45) + " left noenhanced font ',12' textcolor rgb '#505050'\n";
  if (metrics.settling_time_s) {
    const std::string at =
        shortest(in(maneuver.last_action_s + *metrics.settling_time_s - maneuver.first_action_s, 1));
    text += "set arrow 1 from " + at + ", graph 0 to " + at +
            ", graph 1 nohead lw 1.2 dt (3,3) lc rgb '#404040' front\n";
  }
  return text;
}

std::string plot(const Panel& panel, const std::vector<double>& range) {
  std::string text = "set ylabel " + quoted(panel.label) + " offset 1,0\n";
  text += "set yrange [" + shortest(range[0]) + ":" + shortest(range[1]) + "]\nunset object 1\n";
  if (panel.band > 0) {
    const std::string band = shortest(panel.band);
    text += "set object 1 rectangle from graph 0, first -" + band + " to graph 1, first " + band +
            " behind fillcolor rgb '#e9e9e9' fillstyle solid noborder\n";
  }
  std::string separator = "plot ";
  for (const Curve& curve : panel.curves) {
    text += separator + "$run using 1:" + std::to_string(curve.column) + " with lines lc rgb '" +
            curve.colour + "' " + curve.style + " title " + quoted(curve.name);
    separator = ", \\\n     ";
  }
  return text + "\n";
}

double value_of(const Sample& s, int column) {
  switch (column) {
    case kTrolley:
      return s.position[0];
    case kTrolleyRef:
      return s.reference[0];
    case kSlew:
      return s.position[1] * kDegPerRad;
    case kSlewRef:
      return s.reference[1] * kDegPerRad;
    case kHoist:
      return s.position[2];
    case kHoistRef:
      return s.reference[2];
    case kRadial:
      return s.swing_radial_rad * kDegPerRad;
    case kTangential:
      return s.swing_tangential_rad * kDegPerRad;
    case kTrolleyV:
      return s.drive_v[0];
    case kSlewV:
      return s.drive_v[1];
    default:
      return s.drive_v[2];
  }
}

/// y range of the panel's curves, with space for the key at the top.
std::vector<double> range_of(const Panel& panel, std::span<const Sample> run, double zero_s) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Sample& s : run)
    for (const Curve& curve : panel.curves) {
      const double value = value_of(s, curve.column);
      if (s.time_s < zero_s || !std::isfinite(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  if (!(low <= high)) low = high = 0;
  const double middle = (low + high) / 2;
  const double half = std::max((high - low) / 2, panel.smallest_half_range);
  return {in(middle - 1.12 * half, 1), in(middle + 1.45 * half, 1)};
}

}  // namespace

void draw_maneuver(const std::filesystem::path& file, const Caption& caption, std::span<const Sample> run,
                   const Maneuver& maneuver, const Metrics& metrics) {
  const double zero_s = maneuver.first_action_s;
  if (run.empty() || !(run.back().time_s > zero_s))
    throw plot::PictureError(file.string() + ": the run has nothing to draw");
  const std::vector<Panel> panels = panels_of(maneuver);
  const double height = kTop + kBottom + kPanelHeight * static_cast<double>(panels.size());
  std::string script = data_block(run, zero_s);
  script += settings(caption, maneuver, metrics, in(run.back().time_s - zero_s, 1), height);
  script += "set multiplot\n";
  for (std::size_t i = 0; i < panels.size(); ++i) {
    constexpr double kGap = 16;
    const double top = kTop + kPanelHeight * static_cast<double>(i);
    script += "set tmargin at screen " + shortest(1 - top / height) + "\n";
    script += "set bmargin at screen " + shortest(1 - (top + kPanelHeight - kGap) / height) + "\n";
    const bool last = i + 1 == panels.size();
    script += last ? "set xlabel 'time [s]'\nset format x '%g'\n" : "set format x ''\n";
    script += plot(panels[i], range_of(panels[i], run, zero_s));
    if (i == 0) script += "unset label 1\nunset label 2\n";
  }
  plot::draw_script(file, kWidth, height, script + "unset multiplot\n");
}

}  // namespace crane::experiment
