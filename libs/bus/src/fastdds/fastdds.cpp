#include <fastdds/rtps/attributes/ServerAttributes.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastrtps/xmlparser/XMLProfileManager.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/log/Log.hpp>

#include <cstdlib>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "announcement.hpp"
#include "crane/bus/ports.hpp"
#include "discovery.hpp"
#include "discovery_server.hpp"
#include "fastdds/endpoints.hpp"
#include "fastdds/found_endpoints.hpp"
#include "fastdds/security.hpp"
#include "fastdds/topic_type.hpp"
#include "vendor_log.hpp"

namespace crane::bus {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace fastrtps = eprosima::fastrtps;
using fastdds::duration;
using namespace std::chrono_literals;

/// The environment of another program with Fast DDS, or a file DEFAULT_FASTRTPS_PROFILES.xml in the working
/// directory, does not change the participants: with ROS_DISCOVERY_SERVER an operator's stop would reach only
/// this server. Later buses do not write the environment, which other threads may read.
void ignore_environment() {
  static std::once_flag once;
  std::call_once(once, [] {
    for (const auto* name :
         {"ROS_DISCOVERY_SERVER", "FASTDDS_ENVIRONMENT_FILE", "FASTRTPS_DEFAULT_PROFILES_FILE"})
      ::unsetenv(name);
    ::setenv("SKIP_DEFAULT_XML_FILE", "1", 1);
  });
}

/// Two buses of one process communicate like two processes.
void switch_intraprocess_delivery_off() {
  static std::once_flag once;
  std::call_once(once, [] {
    fastrtps::LibrarySettingsAttributes settings;
    settings.intraprocess_delivery = fastrtps::INTRAPROCESS_OFF;
    fastrtps::xmlparser::XMLProfileManager::library_settings(settings);
  });
}

/// Writes the log to standard error. Standard output contains only the results of a tool.
class LogToVendorLog final : public dds::LogConsumer {
 public:
  void Consume(const dds::Log::Entry& entry) override { vendor_log("Fast DDS", entry.message); }
};

void report_to_vendor_log() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    dds::Log::RegisterConsumer(std::make_unique<LogToVendorLog>());
  });
}

void bind_to_interfaces(dds::DomainParticipantQos& qos, const Options& options) {
  constexpr std::uint32_t kBufferBytes = 1U << 20U;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = options.interfaces;
  udp->sendBufferSize = kBufferBytes;
  udp->receiveBufferSize = kBufferBytes;
  udp->non_blocking_send = true;
  qos.transport().use_builtin_transports = false;  // no shared memory
  qos.transport().user_transports.push_back(std::move(udp));
}

/// Contacts the known ports of this host and of the peers.
void discover_peers(dds::DomainParticipantQos& qos, const Options& options) {
  auto hosts = options.peers;
  hosts.insert(hosts.end(), options.interfaces.begin(), options.interfaces.end());
  fastrtps::rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  for (const auto& host : hosts) {
    fastrtps::rtps::IPLocator::setIPv4(locator, host);
    for (std::uint32_t index = 0; index < kMostParticipants; ++index) {
      locator.port = qos.wire_protocol().port.getUnicastPort(options.domain, index);
      qos.wire_protocol().builtin.initialPeersList.push_back(locator);
    }
  }
}

/// Contacts a Discovery Server only. A SUPER_CLIENT also receives the announcements of participants without a
/// matching endpoint, whose message versions this project compares.
void discover_by_server(dds::DomainParticipantQos& qos, const std::string& address_and_port) {
  const auto [address, port] = discovery_server_in(address_and_port);
  fastrtps::rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  fastrtps::rtps::IPLocator::setIPv4(locator, address);
  locator.port = port;
  fastrtps::rtps::RemoteServerAttributes server;
  fastrtps::rtps::get_server_client_default_guidPrefix(0, server.guidPrefix);
  server.metatrafficUnicastLocatorList.push_back(locator);
  auto& config = qos.wire_protocol().builtin.discovery_config;
  config.discoveryProtocol = fastrtps::rtps::DiscoveryProtocol_t::SUPER_CLIENT;
  config.m_DiscoveryServers.push_back(server);
}

/// @param numbered  false: the participant joins without a number
void receive_by_unicast(dds::DomainParticipantQos& qos, const Options& options, bool numbered) {
  auto& builtin = qos.wire_protocol().builtin;
  builtin.avoid_builtin_multicast = true;
  fastrtps::rtps::Locator_t any;
  any.kind = LOCATOR_KIND_UDPv4;
  // Port 0: that of the participant number.
  if (!numbered) any.port = any_free_port(options);
  builtin.metatrafficUnicastLocatorList.push_back(any);
  if (numbered) return;
  any.port = any_free_port(options);
  qos.wire_protocol().default_unicast_locator_list.push_back(any);
}

dds::DomainParticipantQos participant_qos(const Options& options, int number) {
  const bool numbered = number < static_cast<int>(kMostParticipants);
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  qos.wire_protocol().participant_id = number;
  qos.name(options.participant);
  const std::string announced = announcement(options);
  qos.user_data().setValue({announced.begin(), announced.end()});
  auto& builtin = qos.wire_protocol().builtin;
  builtin.discovery_config.leaseDuration = duration(10s);
  builtin.discovery_config.leaseDuration_announcementperiod = duration(2500ms);
  builtin.discovery_config.initial_announcements.count = 20;
  builtin.discovery_config.initial_announcements.period = duration(50ms);
  builtin.typelookup_config.use_client = false;
  builtin.typelookup_config.use_server = false;
  bind_to_interfaces(qos, options);
  if (options.credentials) fastdds::secure(qos, *options.credentials);
  if (!discovers_by_unicast(options)) return qos;
  receive_by_unicast(qos, options, numbered);
  if (options.discovery_server.empty())
    discover_peers(qos, options);
  else
    discover_by_server(qos, options.discovery_server);
  return qos;
}

/// Participant numbers of this process. By default Fast DDS never uses a number twice. Unicast
/// discovery contacts only the ports of numbers below kMostParticipants.
class ParticipantNumber {
 public:
  /// From kMostParticipants on: no number was free, and the participant joins without one.
  /// @throws Error when unicast discovery finds no free number, and the participant needs one
  explicit ParticipantNumber(const Options& options) {
    const std::lock_guard lock{mutex()};
    const bool unicast = discovers_by_unicast(options);
    constexpr int kMost = static_cast<int>(kMostParticipants);
    const auto is_taken = [&] {
      return used().contains(number_) ||
             (unicast && number_ < kMost && !has_free_ports(options, static_cast<std::uint32_t>(number_)));
    };
    for (; is_taken(); ++number_)
      if (unicast && number_ + 1 >= kMost && !joins_without_number(options))
        throw Error{"Fast DDS: " + no_free_number(options)};
    used().insert(number_);
  }
  ParticipantNumber(const ParticipantNumber&) = delete;
  ParticipantNumber& operator=(const ParticipantNumber&) = delete;
  ~ParticipantNumber() {
    const std::lock_guard lock{mutex()};
    if (!kept_) used().erase(number_);
  }
  /// Fast DDS does not release the number of a participant that it failed to create.
  void keep() { kept_ = true; }
  [[nodiscard]] int value() const { return number_; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  static std::set<int>& used() {
    static std::set<int> instance;
    return instance;
  }
  int number_ = 0;
  bool kept_ = false;
};

struct ParticipantDeleter {
  void operator()(dds::DomainParticipant* participant) const {
    participant->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
  }
};

/// Stores the announcements of participants and endpoints. Runs on a thread of Fast DDS.
class Discovery final : public dds::DomainParticipantListener {
 public:
  explicit Discovery(const Options& options) : census_{options.messages_version, options.crane} {}

  void on_participant_discovery(dds::DomainParticipant* /*own*/,
                                fastrtps::rtps::ParticipantDiscoveryInfo&& found) override {
    Census::Key key{};
    std::copy_n(std::begin(found.info.m_guid.guidPrefix.value), 12, key.begin());
    std::copy_n(std::begin(found.info.m_guid.entityId.value), 4, key.begin() + 12);
    using Info = fastrtps::rtps::ParticipantDiscoveryInfo;
    if (found.status == Info::REMOVED_PARTICIPANT || found.status == Info::DROPPED_PARTICIPANT)
      return census_.forget(key);
    const auto& data = found.info.m_userData.getValue();
    census_.note(key, std::string{data.begin(), data.end()});
  }
  void on_publisher_discovery(dds::DomainParticipant* /*own*/,
                              fastrtps::rtps::WriterDiscoveryInfo&& found) override {
    endpoints_.note(found);
  }
  void on_subscriber_discovery(dds::DomainParticipant* /*own*/,
                               fastrtps::rtps::ReaderDiscoveryInfo&& found) override {
    endpoints_.note(found);
  }
  [[nodiscard]] const Census& census() const { return census_; }
  [[nodiscard]] const fastdds::FoundEndpoints& endpoints() const { return endpoints_; }

 private:
  Census census_;
  fastdds::FoundEndpoints endpoints_;
};

class FastBackEnd final : public BackEnd {
 public:
  explicit FastBackEnd(const Options& options) : discovery_{options}, number_{options} {
    ignore_environment();
    switch_intraprocess_delivery_off();
    report_to_vendor_log();
    auto* factory = dds::DomainParticipantFactory::get_instance();
    participant_.reset(factory->create_participant(options.domain, participant_qos(options, number_.value()),
                                                   &discovery_, dds::StatusMask::none()));
    if (!participant_) {
      number_.keep();
      throw Error{"Fast DDS: " + cannot_join(options)};
    }
    dds::PublisherQos publisher_qos = dds::PUBLISHER_QOS_DEFAULT;
    publisher_qos.partition().push_back(options.crane.c_str());
    publisher_ = participant_->create_publisher(publisher_qos);
    dds::SubscriberQos subscriber_qos = dds::SUBSCRIBER_QOS_DEFAULT;
    subscriber_qos.partition().push_back(options.crane.c_str());
    subscriber_ = participant_->create_subscriber(subscriber_qos);
    if (publisher_ == nullptr || subscriber_ == nullptr)
      throw Error{"Fast DDS: cannot use the crane name '" + options.crane + "' as a partition"};
  }

  std::unique_ptr<detail::Writer> writer(const topics::Description& description,
                                         const EndpointOptions& options) override {
    return fastdds::make_writer(shared_from_this(), *publisher_, topic(description), description, options);
  }
  std::unique_ptr<detail::Reader> reader(const topics::Description& description,
                                         const EndpointOptions& options,
                                         std::shared_ptr<Doorbell> doorbell) override {
    return fastdds::make_reader(shared_from_this(), *subscriber_, topic(description), description, options,
                                std::move(doorbell));
  }

  std::vector<OtherVersion> other_versions() override { return discovery_.census().others(); }
  std::vector<FoundEndpoint> found_endpoints() override {
    return discovery_.endpoints().all([this](const auto& one) { return origin_of(one); });
  }
  std::string origin_of(const ParticipantId& participant) override {
    return discovery_.census().origin_of(participant);
  }

 private:
  dds::Topic& topic(const topics::Description& description) {
    const std::string name{description.name};
    const std::string type{description.descriptor->m_typename};
    if (auto* known = participant_->lookup_topicdescription(name)) return *dynamic_cast<dds::Topic*>(known);
    if (participant_->find_type(type).empty())
      dds::TypeSupport{new fastdds::TopicType{*description.descriptor}}.register_type(participant_.get());
    dds::Topic* created = participant_->create_topic(name, type, dds::TOPIC_QOS_DEFAULT);
    if (created == nullptr) throw Error{"Fast DDS: cannot create topic " + name};
    return *created;
  }

  Discovery discovery_;       // must outlive the participant
  ParticipantNumber number_;  // released after the participant is deleted
  std::unique_ptr<dds::DomainParticipant, ParticipantDeleter> participant_;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
};

}  // namespace

std::shared_ptr<BackEnd> make_fastdds(const Options& options) {
  return std::make_shared<FastBackEnd>(options);
}

}  // namespace crane::bus
