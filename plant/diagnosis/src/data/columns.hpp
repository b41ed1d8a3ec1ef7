#pragma once
/// The columns of a table that a run is made of, and what is wrong with them.
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

/// One column of the file; without values when it is not there or the rig has nothing that it could measure.
struct Source {
  std::string name;
  const std::vector<double>* values = nullptr;
};

struct Columns {
  const std::vector<double>* time_s = nullptr;
  std::array<Source, kOutputs> outputs;
  std::array<Source, 2> commands;  ///< of trolley and slew
  Source cable;
  const std::vector<double>* stretch = nullptr;  ///< number of the stretch that counts, by row
  double load_mass_kg = 0;                       ///< 0: the rig's own
};

/// What was noticed in one file.
struct Findings {
  std::string file;
  std::vector<std::string> problems, notes;

  void problem(const std::string& column, const std::string& what, const std::string& rule) {
    problems.push_back(file + ": " + column + ": " + what + ": " + rule);
  }
  void note(const std::string& text) { notes.push_back(file + ": " + text); }
};

/// Whether every row has a time of its own, in order. Rows that repeat a time are left out.
[[nodiscard]] bool times_increase(recording::Table& table, Findings& findings);

/// Finds the columns that the rig has, and what is wrong with their names, units and values.
[[nodiscard]] Columns checked_columns(const recording::Table& table, const configuration::Rig& rig,
                                      Findings& findings);

/// As messages say it.
[[nodiscard]] inline std::string number(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

}  // namespace crane::diagnosis
