#pragma once
/// Writer and reader of the Fast DDS back end.
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <memory>

#include "back_end.hpp"

namespace crane::bus::fastdds {

[[nodiscard]] eprosima::fastrtps::Duration_t duration(std::chrono::nanoseconds time);  ///< 0: infinite

std::unique_ptr<detail::Writer> make_writer(std::shared_ptr<BackEnd> back_end,
                                            eprosima::fastdds::dds::Publisher& publisher,
                                            eprosima::fastdds::dds::Topic& topic,
                                            const topics::Description& description,
                                            const EndpointOptions& options, bool network);
std::unique_ptr<detail::Reader> make_reader(std::shared_ptr<BackEnd> back_end,
                                            eprosima::fastdds::dds::Subscriber& subscriber,
                                            eprosima::fastdds::dds::Topic& topic,
                                            const topics::Description& description,
                                            const EndpointOptions& options,
                                            std::shared_ptr<Doorbell> doorbell, bool network);

}  // namespace crane::bus::fastdds
