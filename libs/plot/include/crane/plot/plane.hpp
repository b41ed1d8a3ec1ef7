#pragma once
/// Quantities over a plane of two parameters, side by side as coloured maps with contour lines, drawn by
/// gnuplot. Same maps, same bytes.
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
  std::vector<double> values;  ///< x fastest; those below 0 are left blank
};

struct PlaneMark {
  std::string name;
  double x = 0, y = 0;
};

struct Plane {
  PlaneAxis x, y;
  double largest = 1;            ///< of the colour scale, which begins at 0
  double contour_step = 0.1;     ///< contour lines from 0 on
  std::vector<PlaneMark> marks;  ///< at most four
};

/// @param file ends in .svg or .png; its directory must exist. @throws PictureError
void draw_plane(const std::filesystem::path& file, const std::string& title, const Plane& plane,
                const std::vector<PlaneMap>& maps);

}  // namespace crane::plot
