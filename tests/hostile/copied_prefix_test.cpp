/// A program of Fast DDS that joins with the GUID prefix of a process of the loop, as the public interface of
/// Fast DDS permits, and writes a loop topic. Permitted: the crane stops. Forbidden: motion.
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <cstring>
#include <memory>

#include "../system/stranger.hpp"
#include "crane/bus/cdr.hpp"
#include "crane/bus/ports.hpp"
#include "crane/bus/seal.hpp"
#include "discovery_attack.hpp"

namespace crane::hostile {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// A type whose samples are CDR bytes with their encapsulation header.
class RawType final : public dds::TopicDataType {
 public:
  explicit RawType(const char* name) {
    setName(name);
    m_typeSize = 64U << 10U;
    m_isGetKeyDefined = false;
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<const Bytes*>(data);
    if (bytes.size() > payload->max_size) return false;
    std::memcpy(payload->data, bytes.data(), bytes.size());
    payload->length = static_cast<std::uint32_t>(bytes.size());
    payload->encapsulation = CDR_LE;
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t*, void*) override { return false; }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const Bytes*>(data)->size()); };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

/// One writer in a participant with a chosen prefix; zeros: Fast DDS chooses the prefix.
class PrefixedWriter {
 public:
  PrefixedWriter(const runtime::BusOptions& options, const GuidPrefix& prefix,
                 const topics::Description& topic) {
    auto qos = dds::PARTICIPANT_QOS_DEFAULT;
    std::copy(prefix.begin(), prefix.end(), qos.wire_protocol().prefix.value);
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList = {"127.0.0.1"};
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    auto& builtin = qos.wire_protocol().builtin;
    builtin.discovery_config.initial_announcements.count = 20;
    constexpr std::uint32_t kParticipants = 24;  // more than the processes of this test
    qos.wire_protocol().participant_id = kParticipants;
    rtps::Locator_t locator;
    locator.kind = LOCATOR_KIND_UDPv4;
    rtps::IPLocator::setIPv4(locator, "127.0.0.1");
    for (std::uint32_t number = 0; number < kParticipants; ++number) {
      locator.port = bus::unicast_port(options.domain, number);
      builtin.initialPeersList.push_back(locator);
    }
    builtin.typelookup_config.use_client = builtin.typelookup_config.use_server = false;
    auto* factory = dds::DomainParticipantFactory::get_instance();
    participant_ = factory->create_participant(options.domain, qos);
    if (participant_ == nullptr) throw std::runtime_error("Fast DDS refuses the prefix");
    dds::TypeSupport type{new RawType{topic.descriptor->m_typename}};
    type.register_type(participant_);
    topic_ =
        participant_->create_topic(std::string{topic.name}, type.get_type_name(), dds::TOPIC_QOS_DEFAULT);
    auto publisher_qos = dds::PUBLISHER_QOS_DEFAULT;
    publisher_qos.partition().push_back(options.crane.c_str());
    publisher_ = participant_->create_publisher(publisher_qos);
    auto writer_qos = dds::DATAWRITER_QOS_DEFAULT;
    writer_qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    writer_qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
    writer_qos.representation().m_value = {dds::XCDR_DATA_REPRESENTATION};
    writer_qos.data_sharing().off();
    writer_ = publisher_->create_datawriter(topic_, writer_qos);
    if (writer_ == nullptr) throw std::runtime_error("Fast DDS refuses the writer");
  }
  ~PrefixedWriter() {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  PrefixedWriter(const PrefixedWriter&) = delete;
  PrefixedWriter& operator=(const PrefixedWriter&) = delete;

  [[nodiscard]] bool has(const GuidPrefix& prefix) const {
    return std::equal(prefix.begin(), prefix.end(), participant_->guid().guidPrefix.value);
  }
  [[nodiscard]] int readers() {
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.total_count;
  }
  void write(Bytes bytes) { writer_->write(&bytes); }

 private:
  dds::DomainParticipant* participant_ = nullptr;
  dds::Topic* topic_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::DataWriter* writer_ = nullptr;
};

struct Imitated {
  const char* topic;
  const char* process;  ///< that receives a packet of the genuine writer
  const char* vendor;
};
std::ostream& operator<<(std::ostream& out, const Imitated& one) {
  return out << one.topic << " with " << one.vendor;
}

class CopiedPrefix : public DiscoveryAttack, public testing::WithParamInterface<Imitated> {
 protected:
  void SetUp() override {
    if (!Ear::permitted()) GTEST_SKIP() << "listening on the loop-back interface needs CAP_NET_RAW";
    auto options = default_options();
    options.bus.vendor = GetParam().vendor;
    start(options);
  }
  /// Writes for 3 s, longer than Fast DDS and Cyclone DDS need to match a writer.
  /// @param killed   process that ends before the attack; empty: none
  /// @param copied  false: Fast DDS chooses the prefix
  void attack(const std::string& killed = "", bool copied = true) {
    system_test::with_forgery_of(GetParam().topic, [&](const auto& topic, auto spoil) {
      auto packet = heard(GetParam().process, topic);
      auto sample = find(packet.message, topic).value().sample;
      const auto prefix = copied ? prefix_of(packet.message) : GuidPrefix{};
      if (!killed.empty()) stack_->send(killed, SIGKILL);
      PrefixedWriter writer{stack_->bus_options(), prefix, topic.description};
      ASSERT_EQ(writer.has(prefix), copied);
      spoil(sample);
      stack_->forget();
      (void)stack_->until(
          [&] {
            if (states().empty()) return false;
            for (const std::uint64_t ahead : {0, 1}) {
              auto forged = sample;
              forged.header.tick = states().back().header.tick + ahead;
              forged.header.sample_time_ns = states().back().header.sample_time_ns;
              bus::seal(topic.description, &forged, forged.header.source, forged.header.epoch);
              const auto& codec = bus::CdrCodec::of(*topic.description.descriptor);
              Bytes bytes(bus::kEncapsulation_bytes + codec.max_encoded_bytes());
              bytes[1] = 1;  // little endian
              const auto size = codec.encode(&forged, std::span{bytes}.subspan(bus::kEncapsulation_bytes));
              bytes.resize(bus::kEncapsulation_bytes + size);
              writer.write(std::move(bytes));
            }
            return false;
          },
          3s);
      readers_ = writer.readers();
      std::cout << readers_ << " readers have matched; ";
    });
  }
  int readers_ = 0;
};

TEST_P(CopiedPrefix, MovesNothingOfALockedCrane) {
  attack();
  expect_nothing_moved(states());
  std::cout << '\n';
}

TEST_P(CopiedPrefix, StopsAnArmedCraneInsteadOfMovingIt) {
  stack_->session().arm();
  attack();
  expect_hold_or_stop();
}

std::string route_of(const testing::TestParamInfo<Imitated>& test) {
  return std::string{test.param.topic} + "_" + test.param.vendor;
}
INSTANTIATE_TEST_SUITE_P(OnEveryLoopTopic, CopiedPrefix, testing::ValuesIn(routes_in_turn<Imitated>(true)),
                         route_of);
INSTANTIATE_TEST_SUITE_P(LongOnEveryLoopTopic, CopiedPrefix,
                         testing::ValuesIn(routes_in_turn<Imitated>(false)), route_of);

class PrefixOfAKilledSupervisor : public CopiedPrefix {};

TEST_P(PrefixOfAKilledSupervisor, MovesNothing) {
  attack("supervisor");
  expect_nothing_moved(states());
  std::cout << '\n';
}

class OtherPrefix : public CopiedPrefix {};

/// The same program with another prefix is matched and stops the crane: it is an effective writer.
TEST_P(OtherPrefix, StopsAnArmedCraneInsteadOfMovingIt) {
  stack_->session().arm();
  attack("", false);
  expect_hold_or_stop();
  EXPECT_GT(readers_, 0);
  EXPECT_FALSE(is(crane_STATE_HOLD));
}

const auto kCommands =
    testing::Values(Imitated{"command", "plant", "cyclone"}, Imitated{"command", "plant", "fastdds"});
const auto vendor_of = [](const auto& test) { return std::string{test.param.vendor}; };
INSTANTIATE_TEST_SUITE_P(Of, PrefixOfAKilledSupervisor, kCommands, vendor_of);
INSTANTIATE_TEST_SUITE_P(Of, OtherPrefix, kCommands, vendor_of);

}  // namespace
}  // namespace crane::hostile
