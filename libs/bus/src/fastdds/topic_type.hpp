#pragma once
/// Type of a topic for Fast DDS: the struct of idlc, encoded with CdrCodec.
#include <fastdds/dds/topic/TopicDataType.hpp>

#include "crane/bus/cdr.hpp"

namespace crane::bus::fastdds {

class TopicType final : public eprosima::fastdds::dds::TopicDataType {
 public:
  explicit TopicType(const dds_topic_descriptor_t& descriptor);

  bool serialize(void* sample, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override;
  /// A payload that is not a sample of this type is decoded to a sample with a wrong CRC. The subscriber then
  /// rejects and counts it. Otherwise Fast DDS would drop the payload without a report.
  bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* sample) override;
  std::function<std::uint32_t()> getSerializedSizeProvider(void* sample) override;
  bool getKey(void* sample, eprosima::fastrtps::rtps::InstanceHandle_t* handle, bool force_md5) override;
  void* createData() override;
  void deleteData(void* sample) override;
  bool is_bounded() const override { return true; }
  bool is_plain() const override { return false; }

 private:
  const CdrCodec& codec_;
};

}  // namespace crane::bus::fastdds
