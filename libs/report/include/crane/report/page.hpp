#pragma once
/// Self-contained pages: one HTML file with text, tables, pictures and interactive plots. Nothing is loaded
/// from a network: the plotting library (uPlot) and the data are inside. Same page, same bytes. Every text is
/// escaped; only Picture::svg goes in as it is.
///
///   Page page{.title = "Maneuver 1", .summary = "Two controllers.", .sections = {}};
///   page.sections.push_back({.title = "Swing", .blocks = {
///       Verdict{.text = "Both settle.", .tone = Tone::good},
///       LinePlot{.title = "radial", .x_label = "time [s]", .y_label = "deg", .x = time_s, .series =
///       {...}}}});
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

/// The answer in one sentence, in a coloured box.
struct Verdict {
  std::string text;
  Tone tone = Tone::neutral;
};

struct Cell {
  std::string text;
  Tone tone = Tone::neutral;
};
/// "0.271 [0.265, 0.277]": a value with its interval, `digits` decimals. NaN gives "-".
[[nodiscard]] Cell with_interval(double value, double low, double high, int digits,
                                 Tone tone = Tone::neutral);
/// "0.271", `digits` decimals. NaN gives "-".
[[nodiscard]] Cell number(double value, int digits, Tone tone = Tone::neutral);

struct Table {
  std::string title;                    ///< may be empty
  std::vector<std::string> header;      ///< one text per column, units in brackets: "settle [s]"
  std::vector<std::vector<Cell>> rows;  ///< cells that begin like a number are set flush right; as many as
                                        ///< the header has, or fewer
};

enum class Style { line, points, band };

/// One curve, cloud of points or band of a plot. NaN and infinite values leave a gap.
struct Series {
  std::string name;
  std::vector<double> x;  ///< empty: the plot's. Points in any order; line and band must not decrease
  std::vector<double> y;  ///< as many as x; of a band the lower edge
  Style style = Style::line;
  std::vector<double> upper;  ///< band only: the upper edge, as many as y
  int color = -1;             ///< of the palette, taken modulo its size; -1: the position in the plot
  bool dashed = false;        ///< lines only
  bool shown = true;          ///< at first; the legend switches it
};

/// Curves over a common axis: the legend switches them, dragging zooms, a double click shows everything
/// again. A scatter plot is one whose series are points.
struct LinePlot {
  std::string title, x_label, y_label;
  std::vector<double> x;  ///< of every series without its own
  std::vector<Series> series;
  std::string group;  ///< plots of the same non-empty group share cursor, zoom and switched series (by name)
};

/// An inline SVG, from `<svg` on; goes into the page unescaped.
struct Picture {
  std::string title;
  std::string svg;
};

using Block = std::variant<Paragraph, Verdict, Table, LinePlot, Picture>;

struct Section {
  std::string title;
  std::vector<Block> blocks;
  bool folded = false;  ///< only the title is visible until it is clicked
};

struct Page {
  std::string title;
  std::string summary;  ///< below the title; may be empty
  std::vector<Section> sections;
};

/// The whole file. @throws std::invalid_argument naming plot and series whose x, y and upper do not fit
/// together, whose x decreases or is not finite, and pictures that are no SVG
[[nodiscard]] std::string to_html(const Page& page);

/// The file cannot be written; names it.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// @param file  its directory must exist. @throws WriteError, and as to_html()
void write_html(const std::filesystem::path& file, const Page& page);

}  // namespace crane::report
