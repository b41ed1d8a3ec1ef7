#pragma once
/// Draws a curve over time with braille characters: 2 x 4 points in each character.
#include <optional>
#include <span>
#include <string>

namespace crane::cli {

struct CurveBox {
  int columns = 70, rows = 6;      ///< characters of the curve, without labels; at least 2 and 1
  double from_s = 0, to_s = 1;     ///< range of the time axis
  std::optional<double> mark_s{};  ///< time of a vertical line
};

/// Smallest and largest finite value.
struct Extent {
  double low = 0, high = 0;
};
[[nodiscard]] std::optional<Extent> extent_of(std::span<const double> values);

/// The curve in box.rows lines with a label of the value at the first and last line. Consecutive values are
/// connected; NaN interrupts the curve. Every value is drawn, so that a peak of one sample is visible.
/// @param time_s  increasing; one time per value
[[nodiscard]] std::string draw_curve(std::span<const double> time_s, std::span<const double> values,
                                     const CurveBox& box);
/// Two lines: axis with ticks, labels in s.
[[nodiscard]] std::string draw_time_axis(const CurveBox& box);

/// Characters left of the curve: label and axis.
inline constexpr int kLabelColumns = 11;

}  // namespace crane::cli
