#include "forging_writer.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <cstring>
#include <stdexcept>

namespace crane::bus::testing {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {
constexpr std::uint32_t kMostBytes = 4096;

/// The "sample" of this type is the payload itself.
class RawType final : public dds::TopicDataType {
 public:
  explicit RawType(const dds_topic_descriptor_t& descriptor) {
    setName(descriptor.m_typename);
    m_typeSize = kMostBytes;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* sample, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<const std::vector<std::uint8_t>*>(sample);
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t*, void*) override { return false; }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* sample) override {
    const auto bytes = static_cast<std::uint32_t>(static_cast<std::vector<std::uint8_t>*>(sample)->size());
    return [bytes] { return bytes; };
  }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
  void* createData() override { return new std::vector<std::uint8_t>; }
  void deleteData(void* sample) override { delete static_cast<std::vector<std::uint8_t>*>(sample); }
};

template <class Entity>
Entity* created(Entity* entity) {
  if (entity == nullptr) throw std::runtime_error{"the forging writer could not be created"};
  return entity;
}

dds::DomainParticipantQos participant_qos() {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(std::move(udp));
  return qos;
}
}  // namespace

struct ForgingWriter::Entities {
  dds::DomainParticipant* participant = nullptr;
  dds::DataWriter* writer = nullptr;
};

ForgingWriter::ForgingWriter(std::uint32_t domain, const std::string& partition,
                             const topics::Description& topic)
    : entities_{std::make_unique<Entities>()} {
  auto* factory = dds::DomainParticipantFactory::get_instance();
  auto* participant = created(factory->create_participant(domain, participant_qos()));
  entities_->participant = participant;
  dds::TypeSupport{new RawType{*topic.descriptor}}.register_type(participant);
  dds::PublisherQos publisher_qos = dds::PUBLISHER_QOS_DEFAULT;
  publisher_qos.partition().push_back(partition.c_str());
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_ALL_HISTORY_QOS;
  qos.endpoint().history_memory_policy = rtps::DYNAMIC_RESERVE_MEMORY_MODE;
  qos.data_sharing().off();
  entities_->writer =
      created(created(participant->create_publisher(publisher_qos))
                  ->create_datawriter(
                      created(participant->create_topic(std::string{topic.name}, topic.descriptor->m_typename,
                                                        dds::TOPIC_QOS_DEFAULT)),
                      qos));
}

ForgingWriter::~ForgingWriter() {
  entities_->participant->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(entities_->participant);
}

bool ForgingWriter::send(std::vector<std::uint8_t> payload) { return entities_->writer->write(&payload); }

int ForgingWriter::matched() const {
  dds::PublicationMatchedStatus status;
  entities_->writer->get_publication_matched_status(status);
  return status.current_count;
}

}  // namespace crane::bus::testing
