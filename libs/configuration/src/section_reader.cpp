#include "section_reader.hpp"

namespace crane::configuration {

std::vector<std::string> board_names() {
  return {
      "simulated",
#define CRANE_BOARD(name, meaning) #name,
#include "crane/configuration/boards.def"
#undef CRANE_BOARD
  };
}

std::vector<std::string> controller_names() {
  std::vector<std::string> names;
  for (const auto& controller : control::controllers()) names.emplace_back(controller.name);
  return names;
}

std::size_t place_of(const std::string& name, const std::vector<std::string>& names) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

bool is_required(Presence presence, const Rig& rig) {
  switch (presence) {
    case Presence::optional:
      return false;
    case Presence::required:
      return true;
    case Presence::required_with_load:
      return rig.carries_load();
    case Presence::required_with_trolley:
      return rig.drives[plant::kTrolley].present;
    case Presence::required_with_slew:
      return rig.drives[plant::kSlew].present;
    case Presence::required_with_hoist:
      return rig.drives[plant::kHoist].present;
  }
  return false;
}

void read_axes(TomlTable& table, const std::string& key, std::array<bool, plant::kAxes>& drives) {
  if (!table.has(key)) return;
  drives.fill(false);
  for (const auto& name : table.texts(key)) {
    const auto* const end = plant::kCoordinates.begin() + plant::kAxes;
    const auto* const named = std::find_if(plant::kCoordinates.begin(), end,
                                           [&name](const plant::Coordinate& c) { return c.name == name; });
    if (named == end)
      table.problem(key, "must name trolley, slew or hoist, not " + name);
    else
      drives[static_cast<std::size_t>(named - plant::kCoordinates.begin())] = true;
  }
}

}  // namespace crane::configuration
