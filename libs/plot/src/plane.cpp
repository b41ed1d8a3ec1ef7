#include "crane/plot/plane.hpp"

#include <array>
#include <cmath>

#include "crane/plot/gnuplot.hpp"
#include "crane/recording/csv.hpp"

namespace crane::plot {
namespace {

constexpr double kMapWidth = 470, kMapHeight = 430, kMapTop = 44;  // pixels
constexpr std::array kMarkShapes{7, 5, 9, 13};                     // circle, square, triangle, rhombus

std::string number_text(double value) { return recording::shortest(std::round(value * 1e6) / 1e6); }

double place(const PlaneAxis& axis, int index) {
  return axis.low + (axis.high - axis.low) * index / (axis.points - 1);
}

/// Data block of gnuplot: rows of x, y, value, with a blank line after each line of the grid.
std::string grid_block(const std::string& name, const Plane& plane, const PlaneMap& map) {
  std::string text = "$" + name + " << END\n";
  std::size_t k = 0;
  for (int j = 0; j < plane.y.points; ++j) {
    for (int i = 0; i < plane.x.points; ++i, ++k)
      text += number_text(place(plane.x, i)) + " " + number_text(place(plane.y, j)) + " " +
              number_text(map.values[k]) + "\n";
    text += "\n";
  }
  return text + "END\n";
}

std::string plane_settings(const Plane& plane) {
  const auto range = [](const PlaneAxis& axis) {
    const double half = (axis.high - axis.low) / (axis.points - 1) / 2;
    return "[" + number_text(axis.low - half) + ":" + number_text(axis.high + half) + "]";
  };
  std::string text = "set encoding utf8\nset border 31 lw 0.8 lc rgb '#404040'\nset tics out scale 0.5\n";
  // Viridis: lightness increases uniformly, readable with colour blindness and in grey.
  text += "set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', 4 '#fde725')\n";
  text += "set cbrange [0:" + number_text(plane.largest) +
          "]\nset key below horizontal center noenhanced samplen 1\n";
  text += "set xlabel " + quoted(plane.x.label) + " noenhanced\nset ylabel " + quoted(plane.y.label) +
          " noenhanced\n";
  text += "set xrange " + range(plane.x) + "\nset yrange " + range(plane.y) + "\n";
  return text + "set cntrparam levels incremental 0," + number_text(plane.contour_step) + "," +
         number_text(plane.largest) + "\n";
}

std::string map_script(std::size_t index, const Plane& plane, const PlaneMap& map) {
  const std::string grid = "map" + std::to_string(index), lines = "contour" + std::to_string(index);
  std::string text = grid_block(grid, plane, map);
  text += "set contour base\nunset surface\nset table $" + lines + "\nsplot $" + grid +
          " using 1:2:3 notitle\nunset table\nunset contour\nset surface\n";
  text += "set title " + quoted(map.title) + " noenhanced\nplot $" + grid +
          " using 1:2:($3 < 0 ? NaN : $3) with image notitle, \\\n     $" + lines +
          " using 1:2 with lines lw 0.8 lc rgb '#ffffff' notitle";
  for (std::size_t i = 0; i < plane.marks.size(); ++i) {
    const PlaneMark& mark = plane.marks[i];
    text += ", \\\n     '+' using (" + number_text(mark.x) + "):(" + number_text(mark.y) +
            ") every ::::0 with points pt " + std::to_string(kMarkShapes.at(i)) +
            " ps 0.9 lc rgb '#d55e00' title " + quoted(mark.name);
  }
  return text + "\n";
}

}  // namespace

void draw_plane(const std::filesystem::path& file, const std::string& title, const Plane& plane,
                const std::vector<PlaneMap>& maps) {
  if (maps.empty()) throw PictureError(file.string() + ": there are no maps to draw");
  const auto points = static_cast<std::size_t>(plane.x.points) * static_cast<std::size_t>(plane.y.points);
  std::string script = plane_settings(plane) + "set multiplot layout 1," + std::to_string(maps.size()) +
                       " title " + quoted(title) + " noenhanced\n";
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (maps[i].values.size() != points)
      throw PictureError(file.string() + ": " + maps[i].title + " must have one value per point");
    script += map_script(i, plane, maps[i]);
  }
  draw_script(file, kMapWidth * static_cast<double>(maps.size()), kMapTop + kMapHeight,
              script + "unset multiplot\n");
}

}  // namespace crane::plot
