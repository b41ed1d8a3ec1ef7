#pragma once
/// Visits the elementary values of a type in the order of their encoding.
#include <stdexcept>

#include "schema_layout.hpp"

namespace crane::recording {

/// @throws std::out_of_range for an unknown type
[[nodiscard]] inline const Structure& structure_named(const IdlTypes& types, std::string_view type) {
  const auto found = types.structures.find(type);
  if (found == types.structures.end()) throw std::out_of_range("the schema has no type " + std::string{type});
  return found->second;
}

/// Calls visit(name, field, index); `index` is the index in the innermost array that contains the value, or 0
/// outside of arrays.
template <class Visit>
void for_each_leaf(const Structure& type, const Visit& visit, const std::string& prefix = "",
                   std::uint32_t outer_index = 0) {
  for (const Field& field : type.fields)
    for (std::uint32_t i = 0; i < field.count; ++i) {
      const std::string name = prefix + field.name + (field.is_array ? "[" + std::to_string(i) + "]" : "");
      const std::uint32_t index = field.is_array ? i : outer_index;
      if (field.kind == Kind::structure)
        for_each_leaf(*field.structure, visit, name + ".", index);
      else
        visit(name, field, index);
    }
}

}  // namespace crane::recording
