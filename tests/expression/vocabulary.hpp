#pragma once
/// Names of the tests: x_m and y_m in columns 0 and 1, angle_rad 2, delay_us 3, open (condition) 4, phase
/// (enumeration) 5 with the values IDLE 0 and BUSY 1.
#include "crane/expression/expression.hpp"

namespace crane::expression {

inline Vocabulary vocabulary() {
  const auto find = [](std::string_view name) -> std::optional<Symbol> {
    const fields::Dimension length{.length = 1}, angle{.angle = 1}, time{.time = 1};
    const Type phase{.kind = Type::Kind::enumeration, .enumeration = "Phase"};
    if (name == "x_m") return Symbol{.type = {.dimension = length}, .column = 0};
    if (name == "y_m") return Symbol{.type = {.dimension = length}, .column = 1};
    if (name == "angle_rad") return Symbol{.type = {.dimension = angle}, .column = 2};
    if (name == "delay_us") return Symbol{.type = {.dimension = time}, .column = 3, .factor = 1e-6};
    if (name == "open") return Symbol{.type = {.kind = Type::Kind::condition}, .column = 4};
    if (name == "phase") return Symbol{.type = phase, .column = 5};
    if (name == "IDLE") return Symbol{.type = phase, .constant = true, .value = 0};
    if (name == "BUSY") return Symbol{.type = phase, .constant = true, .value = 1};
    return std::nullopt;
  };
  return {find, [](std::string_view name) { return "unknown name '" + std::string{name} + "'"; }};
}

}  // namespace crane::expression
