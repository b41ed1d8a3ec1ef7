#include <algorithm>

#include "crane/plant/term.hpp"
#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

std::vector<std::string> term_names() {
  std::vector<std::string> names;
  for (const auto& kind : plant::term_kinds()) names.emplace_back(kind.name);
  return names;
}

void read_term(TomlTable& table, const plant::TermKind& kind, const Rig& rig, plant::TermSetting& term) {
  const std::vector<std::string> axes(kind.axes.begin(), kind.axes.end());
  // A term that acts on the whole crane has no axis. A term that acts on a drive must name it.
  const bool needs_axis = std::find(axes.begin(), axes.end(), "") == axes.end();
  term.axis = needs_axis ? table.choice("axis", axes) : table.choice("axis", axes, "");
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    if (term.axis == plant::kCoordinates[i].axis && !rig.drives[i].present) {
      table.problem("axis", "this rig has no such drive");
    }
  }
  for (const auto& parameter : kind.parameters) {
    if (!table.has(parameter.name)) continue;
    term.parameters[std::string(parameter.name)] =
        table.number(parameter.name, Range::closed(parameter.low, parameter.high));
  }
}

}  // namespace

void read_plant(TomlTable& root, Rig& rig) {
  TomlTable table = root.required_table("plant");
  if (!rig.carries_load()) rig.plant.load_mass_kg = 0;
  read_section(table, plant::kParameterFields, rig.plant, &rig);
  if (!rig.carries_load() && rig.plant.load_mass_kg > 0) {
    table.problem("load_mass_kg", "must be 0: a drive_axis carries no load");
  }
  check_plausible_gains(table, rig.plant, rig);
}

void read_terms(TomlTable& root, Rig& rig) {
  TomlTable model = root.table("model");
  for (TomlTable& table : model.tables("terms")) {
    plant::TermSetting term;
    term.name = table.choice("name", term_names());
    if (const plant::TermKind* kind = plant::find_term(term.name)) {
      read_term(table, *kind, rig, term);
      check_repeated_term(table, rig.terms, term);
    } else {
      table.ignore_unknown();  // the wrong name is reported; its parameters are unknown
    }
    rig.terms.push_back(std::move(term));
  }
}

}  // namespace crane::configuration
