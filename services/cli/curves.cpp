#include "cli/curves.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace crane::cli {
namespace {

constexpr int kDotColumns = 2, kDotRows = 4;  // of one braille character

std::string braille(unsigned dots) {  // U+2800 + dots as UTF-8
  const unsigned code = 0x2800U + dots;
  return {static_cast<char>(0xE0U | (code >> 12U)), static_cast<char>(0x80U | ((code >> 6U) & 0x3FU)),
          static_cast<char>(0x80U | (code & 0x3FU))};
}

/// Bit of a dot of a braille character. Unicode numbers the dots of the upper three rows by column, then the
/// dots of the last row.
unsigned bit_of(int column, int row) {
  constexpr unsigned kBits[kDotRows][kDotColumns]{{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
  return kBits[row][column];
}

class Canvas {
 public:
  explicit Canvas(const CurveBox& box)
      : columns_{box.columns}, rows_{box.rows}, cells_(static_cast<std::size_t>(box.columns * box.rows)) {}

  void dot(int x, int y) {
    if (x < 0 || y < 0 || x >= columns_ * kDotColumns || y >= rows_ * kDotRows) return;
    cells_[static_cast<std::size_t>(y / kDotRows * columns_ + x / kDotColumns)] |=
        bit_of(x % kDotColumns, y % kDotRows);
  }
  void line(int x0, int y0, int x1, int y1) {
    const int steps = std::max({std::abs(x1 - x0), std::abs(y1 - y0), 1});
    for (int i = 0; i <= steps; ++i) {
      const auto between = [&](int a, int b) {
        return a + static_cast<int>(std::lround(static_cast<double>(b - a) * i / steps));
      };
      dot(between(x0, x1), between(y0, y1));
    }
  }
  /// @param mark  column of a vertical line, which is drawn where the curve is not; -1: none
  [[nodiscard]] std::string row(int row, int mark) const {
    std::string text;
    for (int column = 0; column < columns_; ++column) {
      const auto dots = cells_[static_cast<std::size_t>(row * columns_ + column)];
      text += dots != 0 ? braille(dots) : column == mark ? "┊" : " ";
    }
    return text;
  }

 private:
  int columns_, rows_;
  std::vector<unsigned> cells_;
};

std::string label(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%*.4g ", kLabelColumns - 2, value);
  return text;
}

/// Index in [0, columns) of the column of points at `time_s`.
int column_of(double time_s, const CurveBox& box, int columns) {
  const double share = (time_s - box.from_s) / (box.to_s - box.from_s);
  return static_cast<int>(std::lround(share * (columns - 1)));
}

}  // namespace

std::optional<Extent> extent_of(std::span<const double> values) {
  std::optional<Extent> extent;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (!extent) extent = Extent{value, value};
    extent->low = std::min(extent->low, value);
    extent->high = std::max(extent->high, value);
  }
  return extent;
}

std::string draw_curve(std::span<const double> time_s, std::span<const double> values, const CurveBox& box) {
  auto extent = extent_of(values).value_or(Extent{0, 0});
  if (extent.high == extent.low) {  // a constant is drawn in the middle
    const double margin = extent.low == 0 ? 1 : std::abs(extent.low) * 0.5;
    extent = {extent.low - margin, extent.high + margin};
  }
  Canvas canvas{box};
  const int lowest = box.rows * kDotRows - 1;
  const auto y_of = [&](double value) {
    return lowest - static_cast<int>(std::lround((value - extent.low) / (extent.high - extent.low) * lowest));
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const int x = column_of(time_s[i], box, box.columns * kDotColumns), y = y_of(values[i]);
    if (i > 0 && std::isfinite(values[i - 1]))
      canvas.line(column_of(time_s[i - 1], box, box.columns * kDotColumns), y_of(values[i - 1]), x, y);
    else
      canvas.dot(x, y);
  }
  const int mark = box.mark_s ? column_of(*box.mark_s, box, box.columns) : -1;
  std::string text;
  for (int row = 0; row < box.rows; ++row) {
    const bool first = row == 0, last = row == box.rows - 1;
    text += first ? label(extent.high) : last ? label(extent.low) : std::string(kLabelColumns - 1, ' ');
    text += (first || last ? "┤" : "│") + canvas.row(row, mark) + '\n';
  }
  return text;
}

std::string draw_time_axis(const CurveBox& box) {
  constexpr int kLabelEvery = 15;  // columns
  const int labels = std::max(1, (box.columns - 1) / kLabelEvery);
  std::string line(kLabelColumns - 1, ' '), text(static_cast<std::size_t>(kLabelColumns + box.columns), ' ');
  line += "└";
  std::vector<bool> marked(static_cast<std::size_t>(box.columns));
  for (int i = 0; i <= labels; ++i) {
    const int column = (box.columns - 1) * i / labels;
    const double time_s = box.from_s + (box.to_s - box.from_s) * column / (box.columns - 1);
    char number[24];
    const int length = std::snprintf(number, sizeof number, "%.2f s", std::abs(time_s) < 0.005 ? 0 : time_s);
    const int begin =
        std::clamp(kLabelColumns + column - length / 2, 0, kLabelColumns + box.columns - length);
    text.replace(static_cast<std::size_t>(begin), static_cast<std::size_t>(length), number);
    marked[static_cast<std::size_t>(column)] = true;
  }
  const int mark = box.mark_s ? column_of(*box.mark_s, box, box.columns) : -1;
  for (int column = 0; column < box.columns; ++column)
    line += column == mark ? "▲" : marked[static_cast<std::size_t>(column)] ? "┬" : "─";
  text.erase(text.find_last_not_of(' ') + 1);
  return line + '\n' + text + '\n';
}

}  // namespace crane::cli
