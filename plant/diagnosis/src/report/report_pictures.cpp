#include <algorithm>
#include <cmath>

#include "crane/diagnosis/report.hpp"
#include "crane/plot/curves.hpp"
#include "report/residual_view.hpp"

namespace crane::diagnosis {
namespace {

using plot::CurvePanel;
using plot::CurveStyle;

// Points of a curve and of a cloud: the resolution of a screen.
constexpr std::size_t kMostDrawn = 1500, kMostDots = 600;

/// Finite points only.
plot::NamedCurve curve(const std::string& name, CurveStyle style, const std::vector<double>& x,
                       const std::vector<double>& y) {
  plot::NamedCurve result{name, style, {}};
  const std::size_t most = style == CurveStyle::dots ? kMostDots : kMostDrawn;
  const std::size_t every = std::max<std::size_t>(1, (x.size() + most - 1) / most);
  for (std::size_t i = 0; i < x.size(); i += every)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) result.points.push_back({x[i], y[i]});
  return result;
}

void add_panel(std::vector<CurvePanel>& panels, CurvePanel panel) {
  std::erase_if(panel.curves, [](const plot::NamedCurve& c) { return c.points.empty(); });
  if (!panel.curves.empty()) panels.push_back(std::move(panel));
}

std::vector<std::string> runs_of(const std::vector<Trace>& traces) {
  std::vector<std::string> names;
  for (const Trace& trace : traces)
    if (std::find(names.begin(), names.end(), trace.run) == names.end()) names.push_back(trace.run);
  return names;
}

}  // namespace

void draw_diagnosis(const std::filesystem::path& directory, const Diagnosis& diagnosis,
                    const configuration::Rig& rig, const std::vector<Run>& test) {
  const bool is_extended = !diagnosis.extension.empty();
  std::size_t number = 0;
  for (const std::string& run : runs_of(diagnosis.traces)) {
    std::vector<CurvePanel> panels;
    for (const Trace& trace : diagnosis.traces) {
      if (trace.run != run) continue;
      CurvePanel panel{"time [s]", trace.column, {}};
      panel.curves.push_back(curve("measured", CurveStyle::line, trace.time_s, trace.measured));
      panel.curves.push_back(curve("simulation", CurveStyle::dashes, trace.time_s, trace.baseline));
      if (is_extended)
        panel.curves.push_back(curve("extended", CurveStyle::line, trace.time_s, trace.extended));
      add_panel(panels, std::move(panel));
    }
    if (!panels.empty())
      plot::draw_curves(directory / ("overlay_" + std::to_string(++number) + ".svg"), short_name(run),
                        panels);
  }
  for (const ResidualView& view : residual_views(diagnosis, rig, test)) {
    std::vector<CurvePanel> panels;
    for (const Abscissa& abscissa : view.against) {
      CurvePanel panel{abscissa.label, "residual [" + view.unit + "]", {}};
      panel.curves.push_back(curve("simulation", CurveStyle::dots, abscissa.values, view.baseline));
      if (is_extended)
        panel.curves.push_back(curve("extended", CurveStyle::dots, abscissa.values, view.extended));
      add_panel(panels, std::move(panel));
    }
    if (!panels.empty())
      plot::draw_curves(directory / ("residual_" + view.column + ".svg"), "Residual of " + view.column,
                        panels);
  }
}

}  // namespace crane::diagnosis
