#pragma once
#include <dds/dds.h>

#include "crane/bus/bus.hpp"

namespace crane::bus::cyclone {

/// Makes a participant of this quality of service use Cyclone's built-in security plugins.
void secure(dds_qos_t& qos, const Credentials& credentials);

}  // namespace crane::bus::cyclone
