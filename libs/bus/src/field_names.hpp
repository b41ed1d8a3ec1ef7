#pragma once
/// Names of the fields of a type, for error messages. Op-codes contain offsets only; the names come from the
/// XTypes type objects that idlc embeds in the descriptor.
#include <cstddef>
#include <span>
#include <string>

#include "crane/topics.hpp"

namespace crane::bus {

/// @param path index of the member, then of the member inside it, and so on
/// @return for example "axis.position"; "member 3" when the descriptor has no type objects
[[nodiscard]] std::string field_name(const dds_topic_descriptor_t& descriptor,
                                     std::span<const std::size_t> path);

}  // namespace crane::bus
