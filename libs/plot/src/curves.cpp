#include "crane/plot/curves.hpp"

#include <cmath>

#include "crane/plot/gnuplot.hpp"
#include "crane/recording/csv.hpp"

namespace crane::plot {
namespace {

constexpr double kCurvesWidth = 900, kCurvesPanelHeight = 330, kCurvesTop = 44;  // pixels

// Colours of Okabe and Ito, distinguishable with colour blindness.
constexpr std::array kCurveColours{"#0072B2", "#D55E00", "#009E73", "#707070", "#CC79A7"};

std::string number(double value) { return recording::shortest(std::round(value * 1e6) / 1e6); }

const char* style_of(CurveStyle style) {
  switch (style) {
    case CurveStyle::dashes:
      return "lines lw 1.8 dt (8,5)";
    case CurveStyle::dots:
      return "points pt 7 ps 0.3";
    default:
      return "lines lw 1.8 dt 1";
  }
}

std::string data_of(const std::string& name, const NamedCurve& curve) {
  std::string text = "$" + name + " << END\n";
  for (const CurvePoint& point : curve.points) text += number(point.x) + " " + number(point.y) + "\n";
  return text + "END\n";
}

std::string panel_script(std::size_t index, const CurvePanel& panel) {
  std::string data, plot;
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const NamedCurve& curve = panel.curves[i];
    const std::string name = "p" + std::to_string(index) + "c" + std::to_string(i);
    data += data_of(name, curve);
    plot += (plot.empty() ? "plot $" : ", \\\n     $") + name + " using 1:2 with " + style_of(curve.style) +
            " lc rgb '" + kCurveColours.at(i % kCurveColours.size()) + "' title " + quoted(curve.name);
  }
  return data + "set xlabel " + quoted(panel.x_label) + "\nset ylabel " + quoted(panel.y_label) + "\n" +
         plot + "\n";
}

}  // namespace

void draw_curves(const std::filesystem::path& file, const std::string& title,
                 const std::vector<CurvePanel>& panels) {
  for (const CurvePanel& panel : panels)
    for (const NamedCurve& curve : panel.curves)
      if (curve.points.empty()) throw PictureError(file.string() + ": " + curve.name + " has no points");
  if (panels.empty()) throw PictureError(file.string() + ": there are no panels to draw");
  const double height = kCurvesTop + kCurvesPanelHeight * static_cast<double>(panels.size());
  // Names contain underscores, which must not become subscripts.
  std::string script = "set termoption noenhanced\nset encoding utf8\n";
  script += "set border 3 lw 0.8 lc rgb '#404040'\nset tics nomirror out scale 0.5\n";
  script += "set grid xtics ytics lt 1 lw 0.5 lc rgb '#dcdcdc'\nset lmargin 10\n";
  script += "set key tmargin right horizontal samplen 2\n";
  script += "set multiplot layout " + std::to_string(panels.size()) + ",1 title " + quoted(title) + "\n";
  for (std::size_t i = 0; i < panels.size(); ++i) script += panel_script(i, panels[i]);
  draw_script(file, kCurvesWidth, height, script + "unset multiplot\n");
}

}  // namespace crane::plot
