#pragma once
/// Draws functions of two parameters with gnuplot, as coloured maps with contour lines, side by side. Equal
/// maps give equal bytes.
#include <filesystem>
#include <string>
#include <vector>

#include "crane/plot/gnuplot.hpp"

namespace crane::plot {

/// One axis of the plane: `points` >= 2 values from `low` to `high`.
struct PlaneAxis {
  std::string label;
  double low = 0, high = 1;
  int points = 2;
};

struct PlaneMap {
  std::string title;
  std::vector<double> values;  ///< one value per point, x varies fastest; negative values are not drawn
};

struct PlaneMark {
  std::string name;
  double x = 0, y = 0;
};

struct Plane {
  PlaneAxis x, y;
  double largest = 1;            ///< upper end of the colour scale, which starts at 0
  double contour_step = 0.1;     ///< distance between contour lines, which start at 0
  std::vector<PlaneMark> marks;  ///< at most four
};

/// @param file ends in .svg or .png; its directory must exist. @throws PictureError
void draw_plane(const std::filesystem::path& file, const std::string& title, const Plane& plane,
                const std::vector<PlaneMap>& maps);

}  // namespace crane::plot
