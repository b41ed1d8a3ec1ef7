#include <cstring>
#include <memory>
#include <utility>

#include "announcement.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoints.hpp"
#include "cyclone/found_endpoints.hpp"
#include "cyclone/security.hpp"

namespace crane::bus {
namespace {

using cyclone::checked_entity, cyclone::QosPointer;

class CycloneBackEnd final : public BackEnd {
 public:
  explicit CycloneBackEnd(const Options& options)
      : domain_{options}, census_{options.messages_version, options.crane} {
    const QosPointer qos{dds_create_qos()};
    dds_qset_entity_name(qos.get(), options.participant.c_str());
    const std::string announced = announcement(options);
    dds_qset_userdata(qos.get(), announced.data(), announced.size());
    if (options.credentials) cyclone::secure(*qos, *options.credentials);
    participant_ = checked_entity(dds_create_participant(options.domain, qos.get(), nullptr),
                                  "cannot create participant in domain " + std::to_string(options.domain));
    participants_ =
        checked_entity(dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
                       "cannot read the participants of the domain");
    const char* partition = options.crane.c_str();
    const QosPointer group{dds_create_qos()};
    dds_qset_partition(group.get(), 1, &partition);
    publisher_ =
        checked_entity(dds_create_publisher(participant_, group.get(), nullptr), "cannot create publisher");
    subscriber_ =
        checked_entity(dds_create_subscriber(participant_, group.get(), nullptr), "cannot create subscriber");
  }
  CycloneBackEnd(const CycloneBackEnd&) = delete;
  CycloneBackEnd& operator=(const CycloneBackEnd&) = delete;
  ~CycloneBackEnd() override { dds_delete(participant_); }

  std::unique_ptr<detail::Writer> writer(const topics::Description& topic,
                                         const EndpointOptions& options) override {
    return cyclone::make_writer(shared_from_this(), participant_, publisher_, topic, options);
  }
  std::unique_ptr<detail::Reader> reader(const topics::Description& topic, const EndpointOptions& options,
                                         std::shared_ptr<Doorbell> doorbell) override {
    return cyclone::make_reader(shared_from_this(), participant_, subscriber_, topic, options,
                                std::move(doorbell));
  }

  std::vector<OtherVersion> other_versions() override {
    update_census();
    return census_.others();
  }
  std::vector<FoundEndpoint> found_endpoints() override {
    return cyclone::found_endpoints(participant_, [this](const auto& one) { return origin_of(one); });
  }
  std::string origin_of(const ParticipantId& participant) override {
    update_census();
    return census_.origin_of(participant);
  }

 private:
  void update_census() {
    for (;;) {
      void* sample[1] = {nullptr};
      dds_sample_info_t info{};
      if (dds_take(participants_, sample, &info, 1, 1) != 1) return;
      const auto* participant = static_cast<const dds_builtintopic_participant_t*>(sample[0]);
      Census::Key key{};
      std::memcpy(key.data(), participant->key.v, key.size());
      void* data = nullptr;
      std::size_t size = 0;
      if (info.instance_state != DDS_IST_ALIVE)
        census_.forget(key);
      else if (info.valid_data && dds_qget_userdata(participant->qos, &data, &size) && data != nullptr)
        census_.note(key, {static_cast<const char*>(data), size});
      if (data != nullptr) dds_free(data);
      dds_return_loan(participants_, sample, 1);
    }
  }

  cyclone::Domain domain_;
  Census census_;
  dds_entity_t participant_ = 0;
  dds_entity_t participants_ = 0;  ///< built-in reader of discovered participants
  dds_entity_t publisher_ = 0;
  dds_entity_t subscriber_ = 0;
};

}  // namespace

std::shared_ptr<BackEnd> make_cyclone(const Options& options) {
  return std::make_shared<CycloneBackEnd>(options);
}

}  // namespace crane::bus
