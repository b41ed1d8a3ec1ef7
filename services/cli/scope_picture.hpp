#pragma once
/// A capture of `crane scope` as curves for the terminal and as a table for a file.
#include <string>

#include "cli/terminal.hpp"
#include "crane/recording/csv.hpp"
#include "observation/acquisition.hpp"

namespace crane::cli {

/// "trigger at tick 1234: ...", then a panel for each column with its unit, extremes and value at the
/// trigger, then the time axis: 0 s is the trigger. Angles are in degrees.
/// @param columns  fields of the rows, in their order
[[nodiscard]] std::string picture_of(const observation::Capture& capture,
                                     const observation::FieldTable& table,
                                     const std::vector<observation::Field>& columns,
                                     const std::string& trigger, const TerminalSize& size);

/// time_s from the trigger (without a trigger: from the first row), tick, and the columns in the unit of
/// their field.
[[nodiscard]] recording::Table table_of(const observation::Capture& capture,
                                        const observation::FieldTable& table,
                                        const std::vector<observation::Field>& columns);

}  // namespace crane::cli
