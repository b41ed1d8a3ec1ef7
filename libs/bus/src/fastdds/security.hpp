#pragma once
#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>

#include "crane/bus/bus.hpp"

namespace crane::bus::fastdds {

/// Makes a participant of this quality of service use Fast DDS's built-in security plugins.
void secure(eprosima::fastdds::dds::DomainParticipantQos& qos, const Credentials& credentials);

}  // namespace crane::bus::fastdds
