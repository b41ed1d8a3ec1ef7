#pragma once
/// Text of `crane top`.
#include <deque>
#include <string>

#include "cli/terminal.hpp"
#include "cli/top_model.hpp"

namespace crane::cli {

struct TopView {
  std::string title;                 ///< first line: crane and domain
  std::optional<TerminalSize> size;  ///< nothing: width and height are unlimited
  bool trends = false;               ///< true: shows the last windows as a sparkline
};
/// State, largest swing, last fault, processes, topics. If the columns do not fit, the least important
/// columns are omitted first. If the rows do not fit, topics without samples are omitted.
[[nodiscard]] std::string top_text(const TopModel& model, const TopView& view, std::int64_t now_ns,
                                   std::int64_t log_now_ns);

/// Draws one block for each value; its height is the ratio of the value to the largest value.
[[nodiscard]] std::string sparkline(const std::deque<double>& values);

}  // namespace crane::cli
