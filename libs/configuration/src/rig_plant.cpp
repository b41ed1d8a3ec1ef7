#include <algorithm>

#include "crane/plant/term.hpp"
#include "rig_sections.hpp"

namespace crane::configuration {
namespace {

enum class When { with_load, with_trolley, with_slew, with_hoist, optional };

struct PlantKey {
  std::string_view key;
  double plant::Parameters::*field;
  Range range;
  When needed;
};

using P = plant::Parameters;
const std::array<PlantKey, 9> kPlantKeys{{
    {"gravity_mps2", &P::gravity_mps2, Range::closed(1e-3, 100), When::optional},
    {"trolley_inertia_kg", &P::trolley_inertia_kg, Range::closed(1e-6, 1e6), When::with_trolley},
    {"trolley_mass_kg", &P::trolley_mass_kg, Range::closed(0, 1e6), When::with_trolley},
    {"load_mass_kg", &P::load_mass_kg, Range::closed(0, 1e6), When::with_load},
    {"jib_inertia_kgm2", &P::jib_inertia_kgm2, Range::closed(1e-6, 1e8), When::with_slew},
    {"trolley_gain_mps2pv", &P::trolley_gain_mps2pv, Range::closed(1e-6, 1e3), When::with_trolley},
    {"slew_gain_radps2pv", &P::slew_gain_radps2pv, Range::closed(1e-6, 1e3), When::with_slew},
    {"hoist_gain_mpspv", &P::hoist_gain_mpspv, Range::closed(1e-6, 1e3), When::with_hoist},
    {"hoist_lag_s", &P::hoist_lag_s, Range::above(0, 10), When::with_hoist},
}};

bool applies(When when, const Rig& rig) {
  switch (when) {
    case When::with_load:
      return rig.kind != RigKind::drive_axis;
    case When::with_trolley:
      return rig.drives[plant::kTrolley].present;
    case When::with_slew:
      return rig.drives[plant::kSlew].present;
    case When::with_hoist:
      return rig.drives[plant::kHoist].present;
    case When::optional:
      return false;
  }
  return false;
}

std::vector<std::string> term_names() {
  std::vector<std::string> names;
  for (const auto& kind : plant::term_kinds()) names.emplace_back(kind.name);
  return names;
}

void read_term(TomlTable& table, const plant::TermKind& kind, const Rig& rig, plant::TermSetting& term) {
  const std::vector<std::string> axes(kind.axes.begin(), kind.axes.end());
  // A term that acts on the whole crane has no axis; one that acts on a drive has to say which.
  const bool needs_axis = std::find(axes.begin(), axes.end(), "") == axes.end();
  term.axis = needs_axis ? table.choice("axis", axes) : table.choice("axis", axes, "");
  for (std::size_t i = 0; i < plant::kAxes; ++i) {
    if (term.axis == kAxisTexts[i].name && !rig.drives[i].present) {
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
  if (rig.kind == RigKind::drive_axis) rig.plant.load_mass_kg = 0;
  for (const auto& [key, field, range, needed] : kPlantKeys) {
    double& value = rig.plant.*field;
    value = applies(needed, rig) ? table.number(key, range) : table.number(key, range, value);
  }
  if (rig.kind == RigKind::drive_axis && rig.plant.load_mass_kg > 0) {
    table.problem("load_mass_kg", "must be 0: a drive_axis carries no load");
  }
}

void override_plant(TomlTable& table, plant::Parameters& parameters) {
  for (const auto& [key, field, range, needed] : kPlantKeys) {
    parameters.*field = table.number(key, range, parameters.*field);
  }
}

void read_terms(TomlTable& root, Rig& rig) {
  TomlTable model = root.table("model");
  for (TomlTable& table : model.tables("terms")) {
    plant::TermSetting term;
    term.name = table.choice("name", term_names());
    if (const plant::TermKind* kind = plant::find_term(term.name)) {
      read_term(table, *kind, rig, term);
    } else {
      table.ignore_unknown();  // the name has been reported; its parameters cannot be judged
    }
    rig.terms.push_back(std::move(term));
  }
}

}  // namespace crane::configuration
