#include "dashboard/coordinates_script.hpp"

#include <nlohmann/json.hpp>

#include "crane/plant/coordinates.hpp"
#include "dashboard/situation.hpp"

namespace crane::dashboard {

const std::string& coordinates_script() {
  static const std::string kScript = [] {
    auto table = nlohmann::ordered_json::array();
    for (const auto& coordinate : plant::kCoordinates)
      table.push_back({{"name", coordinate.name},
                       {"axis", coordinate.axis},
                       {"unit", coordinate.unit},
                       {"column", coordinate.column},
                       {"driven", coordinate.command_v != nullptr}});
    return "export const COORDINATES = " + text_of(table) + ";\n";
  }();
  return kScript;
}

}  // namespace crane::dashboard
