#pragma once
#include <string>

namespace crane::fields {

/// @return the number with the fewest digits that give the same double when read: "0.1"; NaN: "nan"
[[nodiscard]] std::string shortest(double value);

}  // namespace crane::fields
