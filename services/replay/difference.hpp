#pragma once
/// Compares two samples of a topic bit by bit and names the first field that differs.
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "crane/topics.hpp"

namespace crane::replay {

struct FieldDifference {
  std::string field;               ///< "total_v[1]", "header.tick"; "" when a sample cannot be decoded
  std::string recorded, replayed;  ///< values as text; a NaN with its bits
};

/// Compares the bytes: a NaN equals only a NaN with the same bits, and 0 differs from -0.
/// @param recorded, replayed  plain CDR with the encapsulation header
/// @return nothing when both are equal
[[nodiscard]] std::optional<FieldDifference> first_difference(const topics::Description& topic,
                                                              std::span<const std::uint8_t> recorded,
                                                              std::span<const std::uint8_t> replayed);

}  // namespace crane::replay
