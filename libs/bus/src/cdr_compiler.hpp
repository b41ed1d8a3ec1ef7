#pragma once
/// Reads the op-codes that idlc writes for a type.
#include <vector>

#include "crane/bus/cdr.hpp"

namespace crane::bus {

/// The fields of a type. Nested structs and arrays of structs are replaced by their fields.
/// @throws Error if the type has a construct that a topic must not use
std::vector<CdrCodec::Field> fields_of(const dds_topic_descriptor_t& descriptor);

}  // namespace crane::bus
