/// The elementary values of a type: names, kinds, units.
#include "crane/fields/unit.hpp"
#include "crane/recording/schema.hpp"
#include "leaf_walk.hpp"

namespace crane::recording {
namespace {

/// A boolean, an enumerator and a text have no unit.
bool has_unit(Kind kind) {
  return kind != Kind::boolean && kind != Kind::enumeration && kind != Kind::string;
}

std::string unit_of(const Field& field, std::uint32_t index) {
  if (index < field.units.size()) return field.units[index];
  const auto* const unit = fields::unit_of_name(field.name);
  return unit == nullptr ? "" : std::string{unit->symbol};
}

}  // namespace

std::vector<std::string> Schema::columns(std::string_view type) const {
  std::vector<std::string> names;
  for_each_leaf(structure_named(*types_, type),
                [&](const std::string& name, const Field&, std::uint32_t) { names.push_back(name); });
  return names;
}

std::vector<LeafType> Schema::leaves(std::string_view type) const {
  std::vector<LeafType> leaves;
  for_each_leaf(
      structure_named(*types_, type), [&](const std::string& name, const Field& field, std::uint32_t index) {
        LeafType leaf{.name = name, .kind = field.kind, .unit = "", .enumeration = "", .enumerators = {}};
        if (has_unit(leaf.kind)) leaf.unit = unit_of(field, index);
        if (field.enumeration != nullptr) {
          leaf.enumeration = field.enumeration->name;
          leaf.enumerators = field.enumeration->values;
        }
        leaves.push_back(std::move(leaf));
      });
  return leaves;
}

}  // namespace crane::recording
