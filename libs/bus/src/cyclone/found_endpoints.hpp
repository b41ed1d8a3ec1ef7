#pragma once
#include <dds/dds.h>

#include <functional>
#include <vector>

#include "crane/bus/bus.hpp"

namespace crane::bus::cyclone {

/// Endpoints of all other participants of the domain.
/// @param origin_of  of a participant
[[nodiscard]] std::vector<FoundEndpoint> found_endpoints(
    dds_entity_t own_participant, const std::function<std::string(const ParticipantId&)>& origin_of);

}  // namespace crane::bus::cyclone
