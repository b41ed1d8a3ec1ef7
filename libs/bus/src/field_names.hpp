#pragma once
/// Names of the fields of a type: op-codes have offsets only, but the XTypes type objects idlc embeds in the
/// descriptor carry the names. Used to word error messages.
#include <cstddef>
#include <span>
#include <string>

#include "crane/topics.hpp"

namespace crane::bus {

/// @param path index of the member, then of the member inside it, and so on
/// @return "axis.position"; "member 3" where the descriptor has no type objects
[[nodiscard]] std::string field_name(const dds_topic_descriptor_t& descriptor,
                                     std::span<const std::size_t> path);

}  // namespace crane::bus
