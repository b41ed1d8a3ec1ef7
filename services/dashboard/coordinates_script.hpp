#pragma once
#include <string>

namespace crane::dashboard {

/// "/coordinates.js" of the page: the table of the coordinates (crane/plant/coordinates.hpp) as a script
/// module.
[[nodiscard]] const std::string& coordinates_script();

}  // namespace crane::dashboard
