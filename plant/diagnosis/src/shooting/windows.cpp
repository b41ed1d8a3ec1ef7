#include "shooting/windows.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data/median.hpp"

namespace crane::diagnosis {
namespace {

/// A spline misses g^2 / 32 of an acceleration that changes inside a gap g: 0.5 mm of 1 m/s2 in 2 s / 16.
constexpr double kLongestGap_periods = 1.0 / 16, kLongestGap_rows = 2.5;
/// Measured rows of an output that determine a start.
constexpr std::size_t kFewestRows = 8;

struct Span {
  std::size_t first = 0, last = 0;  ///< last: exclusive
};

}  // namespace

double usual_row_spacing_s(const Run& run, Output output) {
  std::vector<double> distances;
  for (std::size_t row = 0, before = run.rows(); row < run.rows(); ++row) {
    if (!run.is_measured(output, row)) continue;
    if (before < row) distances.push_back(run.instant_s(row) - run.instant_s(before));
    before = row;
  }
  return distances.empty() ? run.period_s : median(std::move(distances));
}

namespace {

/// Cuts spans at the gaps of one output.
std::vector<Span> outside_gaps(const Run& run, Output output, double longest_s,
                               const std::vector<Span>& spans) {
  std::vector<Span> kept;
  for (const Span& span : spans) {
    std::size_t first = span.first, before = span.first;
    for (std::size_t row = span.first; row < span.last; ++row) {
      if (!run.is_measured(output, row)) continue;
      if (run.instant_s(row) - run.instant_s(before) > longest_s) {
        if (before > first) kept.push_back({first, before + 1});
        first = row;
      }
      before = row;
    }
    if (before > first)
      kept.push_back({first, static_cast<double>(span.last - before) * run.period_s > longest_s ? before + 1
                                                                                                : span.last});
  }
  return kept;
}

std::vector<Span> spans_of(const Run& run, Part part, double natural_radps) {
  std::vector<Span> spans{{0, run.rows()}};
  if (!(natural_radps > 0)) return spans;
  const double blind_s = kLongestGap_periods * 2 * std::numbers::pi / natural_radps;
  for (const Output output : kAllOutputs) {
    const bool drive = output == kTrolleyPosition || output == kSlewAngle;
    if (run.measured[output].empty() || drive == (part == Part::drive)) continue;
    if (run.regular(output)) continue;
    spans = outside_gaps(run, output, std::max(blind_s, kLongestGap_rows * usual_row_spacing_s(run, output)),
                         spans);
  }
  return spans;
}

bool determines_start(const PreparedRun& run, Part part, const Window& window) {
  return std::ranges::all_of(simulated_outputs(run, part), [&](Output output) {
    std::size_t measured = 0;
    for (std::size_t k = window.first; k < window.first + window.rows; ++k)
      measured += run.run.is_measured(output, k) ? 1 : 0;
    return measured >= kFewestRows;
  });
}

}  // namespace

std::vector<Window> windows_of(const Runs& runs, Part part, double window_s, double lead_s,
                               double natural_radps) {
  std::vector<Window> windows;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const double period_s = runs[i].run.period_s;
    const auto lead = static_cast<std::size_t>(std::lround(lead_s / period_s));
    for (const Span& span : spans_of(runs[i].run, part, std::isfinite(window_s) ? natural_radps : 0)) {
      const std::size_t rows = span.last - span.first;
      if (rows <= lead) continue;
      const auto wanted =
          std::isfinite(window_s) ? static_cast<std::size_t>(window_s / period_s) : rows - lead;
      if (rows < lead + wanted / 2) continue;
      const std::size_t count = std::max<std::size_t>(1, (rows - lead + wanted / 2) / wanted);
      const std::size_t length = (rows - lead) / count;
      for (std::size_t w = 0; w < count; ++w) {
        const Window window{i, span.first + lead + w * length, length, lead};
        if (determines_start(runs[i], part, window)) windows.push_back(window);
      }
    }
  }
  return windows;
}

}  // namespace crane::diagnosis
