#pragma once
/// Self-contained report pages: one HTML file with text, tables, pictures and interactive plots. The file
/// contains the plotting library (uPlot) and the data, and loads nothing from a network. Equal pages give
/// equal bytes. Every text is escaped, except Picture::svg.
///
///   Page page{.title = "Maneuver 1", .summary = "Two controllers.", .sections = {}};
///   page.sections.push_back({.title = "Swing", .blocks = {
///       Verdict{.text = "Both settle.", .tone = Tone::good},
///       LinePlot{.title = "radial", .x_label = "time [s]", .y_label = "deg", .x = time_s,
///                .series = {...}}}});
///   write_html("out/page.html", page);
#include <filesystem>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace crane::report {

enum class Tone { neutral, good, bad, muted };

struct Paragraph {
  std::string text;
};

/// The result in one sentence, in a coloured box.
struct Verdict {
  std::string text;
  Tone tone = Tone::neutral;
};

struct Cell {
  std::string text;
  Tone tone = Tone::neutral;
};
/// A value with its interval, "0.271 [0.265, 0.277]", with `digits` decimals. NaN gives "-".
[[nodiscard]] Cell with_interval(double value, double low, double high, int digits,
                                 Tone tone = Tone::neutral);
/// A value, "0.271", with `digits` decimals. NaN gives "-".
[[nodiscard]] Cell number(double value, int digits, Tone tone = Tone::neutral);

struct Table {
  std::string title;                    ///< may be empty
  std::vector<std::string> header;      ///< one text per column, units in brackets: "settle [s]"
  std::vector<std::vector<Cell>> rows;  ///< at most as many cells as the header; numbers are aligned right
};

enum class Style { line, points, band };

/// One line, set of points or band of a plot. NaN and infinite values leave a gap.
struct Series {
  std::string name;
  /// empty: x of the plot. Must not decrease for a line or band; any order for points
  std::vector<double> x;
  std::vector<double> y;  ///< as many as x; for a band the lower edge
  Style style = Style::line;
  std::vector<double> upper;  ///< band only: the upper edge, as many as y
  int color = -1;             ///< index in the palette, modulo its size; -1: index of the series in the plot
  bool dashed = false;        ///< lines only
  bool shown = true;          ///< initially visible; the legend toggles the series
};

/// Series over a common x axis. The legend toggles series, dragging zooms, a double click resets the zoom. A
/// scatter plot has series with Style::points.
struct LinePlot {
  std::string title, x_label, y_label;
  std::vector<double> x;  ///< x of every series with an empty x
  std::vector<Series> series;
  std::string group;  ///< plots of one non-empty group share cursor, zoom and visible series (by name)
};

/// An inline SVG; the text must begin with `<svg` and is not escaped.
struct Picture {
  std::string title;
  std::string svg;
};

using Block = std::variant<Paragraph, Verdict, Table, LinePlot, Picture>;

struct Section {
  std::string title;
  std::vector<Block> blocks;
  bool folded = false;  ///< true: the content is hidden until the reader clicks the title
};

struct Page {
  std::string title;
  std::string summary;  ///< below the title; may be empty
  std::vector<Section> sections;
};

/// @return the HTML text of the page. @throws std::invalid_argument, with the names of plot and series, when
///   x, y and upper differ in length, when x decreases or is not finite, or when a picture is not an SVG
[[nodiscard]] std::string to_html(const Page& page);

/// Writes the page, as files::write_file(). @param file  its directory must exist. @throws files::WriteError,
/// and the exceptions of to_html()
void write_html(const std::filesystem::path& file, const Page& page);

}  // namespace crane::report
