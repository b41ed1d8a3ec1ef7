#pragma once
/// The known name that an unknown one most likely means.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace crane::fields {

/// Levenshtein's distance: insertions, deletions and substitutions that make one word of the other.
[[nodiscard]] std::size_t edit_distance(std::string_view from, std::string_view to);

/// @param known  a range of strings. @return the nearest; empty: none is similar
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
