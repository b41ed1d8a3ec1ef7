#pragma once
/// Writer and reader of the Cyclone DDS back end.
#include <dds/dds.h>

#include <memory>

#include "back_end.hpp"

namespace crane::bus::cyclone {

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPointer = std::unique_ptr<dds_qos_t, QosDeleter>;

/// @param group  publisher of the participant. @throws Error
std::unique_ptr<detail::Writer> make_writer(std::shared_ptr<BackEnd> back_end, dds_entity_t participant,
                                            dds_entity_t group, const topics::Description& description,
                                            const EndpointOptions& options);
/// @param group  subscriber of the participant. @throws Error
std::unique_ptr<detail::Reader> make_reader(std::shared_ptr<BackEnd> back_end, dds_entity_t participant,
                                            dds_entity_t group, const topics::Description& description,
                                            const EndpointOptions& options,
                                            std::shared_ptr<Doorbell> doorbell);

}  // namespace crane::bus::cyclone
