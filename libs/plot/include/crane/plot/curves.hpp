#pragma once
/// Draws panels of curves, arranged vertically, with gnuplot. Equal curves give equal bytes.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "crane/plot/gnuplot.hpp"

namespace crane::plot {

enum class CurveStyle { line, dashes, dots };

struct CurvePoint {
  double x = 0, y = 0;
};
struct NamedCurve {
  std::string name;
  CurveStyle style = CurveStyle::line;
  std::vector<CurvePoint> points;
};
struct CurvePanel {
  std::string x_label, y_label;
  std::vector<NamedCurve> curves;  ///< at most five, the number of colours
};

/// @param file ends in .svg or .png; its directory must exist. @throws PictureError
void draw_curves(const std::filesystem::path& file, const std::string& title,
                 const std::vector<CurvePanel>& panels);

}  // namespace crane::plot
