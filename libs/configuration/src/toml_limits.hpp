#pragma once
/// Limits of a TOML text that toml++ does not check. Without these limits a short file could crash the
/// program: each part of a dotted key is a table inside the table of the previous part, and toml++ frees
/// nested tables recursively.
#include <optional>
#include <string>
#include <string_view>

namespace crane::configuration {

constexpr std::size_t kLongestToml_bytes = 1U << 20U;  ///< a hundred times the longest rig file
/// Parts of one dotted key: "a.b.c" has three. With 256 nested values (TOML_MAX_NESTED_VALUES) the depth is
/// at most 8,224 tables; 8 MB of stack suffice for more than 64,000.
constexpr int kMostKeyParts = 32;

struct TomlExcess {
  int line = 1;
  std::string rule;  ///< "must be ..."
};

/// @return the first limit that the text exceeds
[[nodiscard]] std::optional<TomlExcess> excess_of(std::string_view text);

}  // namespace crane::configuration
