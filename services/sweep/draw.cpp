#include "sweep/draw.hpp"

#include <algorithm>

#include "crane/configuration/rig_fields.hpp"
#include "crane/plant/term.hpp"

namespace crane::sweep {
namespace {

template <class Section, std::size_t N>
Number in_section(const std::array<fields::Field<Section>, N>& table, Section& section,
                  const std::string& key) {
  for (const auto& field : table)
    if (field.key == key)
      return {const_cast<double*>(fields::number_of(field, section)), field.range};  // of a mutable section
  return {};
}

/// Finds the parameter of a model term. @param key  "NAME.AXIS.PARAMETER", or "NAME.PARAMETER" for a term
///   without an axis
Number in_terms(configuration::Rig& rig, const std::string& key) {
  const auto first = key.find('.'), last = key.rfind('.');
  if (first == std::string::npos) return {};
  const std::string name = key.substr(0, first), parameter = key.substr(last + 1),
                    axis = first == last ? "" : key.substr(first + 1, last - first - 1);
  const plant::TermKind* kind = plant::find_term(name);
  if (kind == nullptr) return {};
  const auto known = std::find_if(kind->parameters.begin(), kind->parameters.end(),
                                  [&](const plant::TermParameter& p) { return p.name == parameter; });
  const auto term = std::find_if(rig.terms.begin(), rig.terms.end(), [&](const plant::TermSetting& t) {
    return t.name == name && t.axis == axis;
  });
  if (known == kind->parameters.end() || term == rig.terms.end()) return {};
  const auto [place, added] = term->parameters.try_emplace(parameter, known->default_value);
  return {&place->second, fields::Range::closed(known->low, known->high)};
}

}  // namespace

Number number_of(configuration::Rig& rig, const std::string& key) {
  const auto rest = [&key](const std::string& section) { return key.substr(section.size()); };
  if (key.starts_with("plant.")) return in_section(plant::kParameterFields, rig.plant, rest("plant."));
  if (key.starts_with("start.")) return in_section(configuration::kStartFields, rig.start, rest("start."));
  if (key.starts_with("model.terms.")) return in_terms(rig, rest("model.terms."));
  return {};
}

double uniform(std::uint64_t seed, std::size_t index) {
  // splitmix64 of seed and index
  std::uint64_t x = seed * 0x9E3779B97F4A7C15ULL + (index + 1) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  x ^= x >> 31U;
  constexpr double kRange = 9007199254740992;  // 2^53
  return static_cast<double>(x >> 11U) / kRange;
}

}  // namespace crane::sweep
