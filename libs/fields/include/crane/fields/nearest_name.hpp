#pragma once
/// Finds the known name that is most similar to an unknown name.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace crane::fields {

/// Levenshtein's distance: number of insertions, deletions and substitutions that change one word into the
/// other.
[[nodiscard]] std::size_t edit_distance(std::string_view from, std::string_view to);

/// @param known  a range of strings. @return the most similar string; empty: no string is similar
template <class Names>
[[nodiscard]] std::string nearest_name(std::string_view unknown, const Names& known) {
  std::string nearest;
  std::size_t smallest = std::max<std::size_t>(2, unknown.size() / 3) + 1;
  for (const auto& name : known)
    if (const std::size_t distance = edit_distance(unknown, name); distance < smallest) {
      smallest = distance;
      nearest = name;
    }
  return nearest;
}

}  // namespace crane::fields
