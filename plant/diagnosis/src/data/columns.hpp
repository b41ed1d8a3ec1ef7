#pragma once
/// Columns of a run in a table, and their problems.
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

/// One column of the file; no values if it is missing or the rig has no such sensor.
struct Source {
  std::string name;
  const std::vector<double>* values = nullptr;
};

struct Columns {
  const std::vector<double>* time_s = nullptr;
  std::array<Source, kOutputs> outputs;
  std::array<Source, 2> commands;  ///< of trolley and slew
  Source cable;
  const std::vector<double>* stretch = nullptr;  ///< number of the stretch, by row
  double load_mass_kg = 0;                       ///< 0: as in the rig file
};

/// Problems and notes of one file.
struct Findings {
  std::string file;
  std::vector<std::string> problems, notes;

  void problem(const std::string& column, const std::string& what, const std::string& rule) {
    problems.push_back(file + ": " + column + ": " + what + ": " + rule);
  }
  void note(const std::string& text) { notes.push_back(file + ": " + text); }
};

/// Whether times increase. Rows that repeat a time are removed.
[[nodiscard]] bool times_increase(recording::Table& table, Findings& findings);

/// Replaces the positions of an axis at rest by their median. An axis is at rest if it has no command, the
/// other axis has one, and its positions stay within 2 counts. Otherwise a flickering count would be taken
/// for a motion of the support.
void hold_axes_at_rest(recording::Table& table, const configuration::Rig& rig, Findings& findings);

/// Finds the columns of the rig and checks their names, units and values.
[[nodiscard]] Columns checked_columns(const recording::Table& table, const configuration::Rig& rig,
                                      Findings& findings);

/// As in messages.
[[nodiscard]] inline std::string number(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

}  // namespace crane::diagnosis
