#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include "announcement.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/found_endpoints.hpp"
#include "cyclone/security.hpp"

namespace crane::bus {
namespace {

using cyclone::checked_entity;

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPointer = std::unique_ptr<dds_qos_t, QosDeleter>;
struct ListenerDeleter {
  void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};
using ListenerPointer = std::unique_ptr<dds_listener_t, ListenerDeleter>;

dds_duration_t duration(std::chrono::nanoseconds time) {
  return time.count() > 0 ? time.count() : DDS_INFINITY;
}

QosPointer endpoint_qos(const Quality& quality, bool history, const EndpointOptions& endpoint) {
  QosPointer qos{dds_create_qos()};
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_MSECS(10));
  dds_qset_durability(qos.get(), history ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, quality.depth, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
  dds_qset_deadline(qos.get(), duration(endpoint.deadline));
  const bool leased = endpoint.liveliness_lease.count() > 0;
  dds_qset_liveliness(qos.get(), leased ? DDS_LIVELINESS_MANUAL_BY_TOPIC : DDS_LIVELINESS_AUTOMATIC,
                      duration(endpoint.liveliness_lease));
  dds_qset_writer_data_lifecycle(qos.get(), false);  // the end of a writer does not dispose its instances
  const dds_data_representation_id_t plain_cdr = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &plain_cdr);
  return qos;
}

/// Argument of the listeners: the event handler of the endpoint and, for a reader, the doorbell of its bus.
struct Context {
  Announcer announce;
  std::shared_ptr<Doorbell> doorbell;
};
const Context& context(void* argument) { return *static_cast<const Context*>(argument); }

void set_writer_listeners(dds_listener_t* listener) {
  dds_lset_publication_matched(listener, [](dds_entity_t, const dds_publication_matched_status_t s, void* c) {
    context(c).announce.matched(s.current_count_change, static_cast<int>(s.current_count));
  });
  dds_lset_offered_incompatible_qos(
      listener, [](dds_entity_t, const dds_offered_incompatible_qos_status_t s, void* c) {
        context(c).announce(EventKind::incompatible_qos, 0, policy_name(static_cast<int>(s.last_policy_id)));
      });
  dds_lset_offered_deadline_missed(listener,
                                   [](dds_entity_t, const dds_offered_deadline_missed_status_t, void* c) {
                                     context(c).announce(EventKind::deadline_missed);
                                   });
  dds_lset_liveliness_lost(listener, [](dds_entity_t, const dds_liveliness_lost_status_t, void* c) {
    context(c).announce(EventKind::liveliness_lost);
  });
}

void set_reader_listeners(dds_listener_t* listener) {
  dds_lset_data_available(
      listener, [](dds_entity_t, void* c) { context(c).doorbell->ring(context(c).announce.topic); });
  dds_lset_subscription_matched(
      listener, [](dds_entity_t, const dds_subscription_matched_status_t s, void* c) {
        context(c).announce.matched(s.current_count_change, static_cast<int>(s.current_count));
      });
  dds_lset_requested_incompatible_qos(
      listener, [](dds_entity_t, const dds_requested_incompatible_qos_status_t s, void* c) {
        context(c).announce(EventKind::incompatible_qos, 0, policy_name(static_cast<int>(s.last_policy_id)));
      });
  dds_lset_requested_deadline_missed(listener,
                                     [](dds_entity_t, const dds_requested_deadline_missed_status_t, void* c) {
                                       context(c).announce(EventKind::deadline_missed);
                                     });
  dds_lset_liveliness_changed(listener, [](dds_entity_t, const dds_liveliness_changed_status_t s, void* c) {
    const bool gained = s.alive_count_change > 0;
    context(c).announce(gained ? EventKind::liveliness_gained : EventKind::liveliness_lost,
                        static_cast<int>(s.alive_count));
  });
  dds_lset_sample_lost(listener, [](dds_entity_t, const dds_sample_lost_status_t s, void* c) {
    context(c).announce(EventKind::sample_lost, static_cast<int>(s.total_count));
  });
}

/// Topic entity and listener context of one endpoint. They must be deleted after the endpoint.
class Endpoint {
 public:
  Endpoint(std::shared_ptr<BackEnd> back_end, dds_entity_t participant, const topics::Description& topic,
           const EndpointOptions& endpoint, std::shared_ptr<Doorbell> doorbell)
      : back_end_{std::move(back_end)},
        context_{{endpoint.on_event, topic.name}, std::move(doorbell)},
        topic_{checked_entity(dds_create_topic(participant, topic.descriptor, std::string{topic.name}.c_str(),
                                               nullptr, nullptr),
                              "cannot create topic " + std::string{topic.name})} {}
  Endpoint(const Endpoint&) = delete;
  Endpoint& operator=(const Endpoint&) = delete;
  ~Endpoint() { dds_delete(topic_); }

  ListenerPointer listener() { return ListenerPointer{dds_create_listener(&context_)}; }
  [[nodiscard]] dds_entity_t topic() const { return topic_; }
  [[nodiscard]] std::string name() const { return std::string{context_.announce.topic}; }
  [[nodiscard]] BackEnd& back_end() const { return *back_end_; }

 private:
  std::shared_ptr<BackEnd> back_end_;
  Context context_;
  dds_entity_t topic_;
};

class CycloneWriter final : public detail::Writer {
 public:
  CycloneWriter(std::unique_ptr<Endpoint> endpoint, dds_entity_t publisher, const dds_qos_t* qos)
      : endpoint_{std::move(endpoint)} {
    const auto listener = endpoint_->listener();
    set_writer_listeners(listener.get());
    writer_ = checked_entity(dds_create_writer(publisher, endpoint_->topic(), qos, listener.get()),
                             "cannot create writer of " + endpoint_->name());
  }
  CycloneWriter(const CycloneWriter&) = delete;
  CycloneWriter& operator=(const CycloneWriter&) = delete;
  ~CycloneWriter() override { dds_delete(writer_); }

  bool write(const void* sample) override { return dds_write(writer_, sample) == DDS_RETCODE_OK; }
  bool dispose(const void* sample) override { return dds_dispose(writer_, sample) == DDS_RETCODE_OK; }
  bool assert_liveliness() override { return dds_assert_liveliness(writer_) == DDS_RETCODE_OK; }
  [[nodiscard]] int matched() const override {
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(writer_, &status);
    return static_cast<int>(status.current_count);
  }

 private:
  std::unique_ptr<Endpoint> endpoint_;
  dds_entity_t writer_ = 0;
};

class CycloneReader final : public detail::Reader {
 public:
  CycloneReader(std::unique_ptr<Endpoint> endpoint, dds_entity_t subscriber, const dds_qos_t* qos,
                std::size_t sample_bytes)
      : endpoint_{std::move(endpoint)}, sample_bytes_{sample_bytes} {
    const auto listener = endpoint_->listener();
    set_reader_listeners(listener.get());
    reader_ = checked_entity(dds_create_reader(subscriber, endpoint_->topic(), qos, listener.get()),
                             "cannot create reader of " + endpoint_->name());
  }
  CycloneReader(const CycloneReader&) = delete;
  CycloneReader& operator=(const CycloneReader&) = delete;
  ~CycloneReader() override { dds_delete(reader_); }

  bool take(void* sample, SampleInfo& info) override {
    std::memset(sample, 0, sample_bytes_);  // Cyclone DDS does not clear the bytes after the end of a string
    dds_sample_info_t from{};
    void* into[1] = {sample};
    if (dds_take(reader_, into, &from, 1, 1) != 1) return false;
    info = {.source_time_ns = from.source_timestamp,
            .valid = from.valid_data,
            .disposed = from.instance_state == DDS_IST_NOT_ALIVE_DISPOSED};
    // The handle of a matched writer is unique in this process.
    std::memcpy(info.writer.data(), &from.publication_handle, sizeof from.publication_handle);
    info.participant = participant_of(from.publication_handle);
    return true;
  }
  [[nodiscard]] int matched() const override {
    dds_subscription_matched_status_t status{};
    dds_get_subscription_matched_status(reader_, &status);
    return static_cast<int>(status.current_count);
  }
  void matched_writers(std::vector<WriterId>& writers) const override {
    constexpr std::size_t kMost = 64;
    std::array<dds_instance_handle_t, kMost> handles{};
    const auto found = dds_get_matched_publications(reader_, handles.data(), handles.size());
    const auto count = std::min(kMost, static_cast<std::size_t>(std::max<dds_return_t>(found, 0)));
    writers.assign(count, WriterId{});
    for (std::size_t i = 0; i < count; ++i) std::memcpy(writers[i].data(), &handles[i], sizeof handles[i]);
  }
  [[nodiscard]] std::string origin_of(const WriterId& writer) const override {
    dds_instance_handle_t handle = 0;
    std::memcpy(&handle, writer.data(), sizeof handle);
    return endpoint_->back_end().origin_of(participant_of_writer(handle));
  }

 private:
  [[nodiscard]] ParticipantId participant_of_writer(dds_instance_handle_t writer) const {
    ParticipantId participant = kUnknownParticipant;
    if (auto* found = dds_get_matched_publication_data(reader_, writer); found != nullptr) {
      std::memcpy(participant.data(), found->participant_key.v, participant.size());
      dds_builtintopic_free_endpoint(found);
    }
    return participant;
  }
  /// The search takes microseconds and allocates memory. Therefore it is made only when the writer has
  /// changed.
  ParticipantId participant_of(dds_instance_handle_t writer) {
    if (writer == writer_ && participant_ != kUnknownParticipant) return participant_;
    writer_ = writer;
    participant_ = participant_of_writer(writer);
    return participant_;
  }

  std::unique_ptr<Endpoint> endpoint_;
  std::size_t sample_bytes_;
  dds_entity_t reader_ = 0;
  dds_instance_handle_t writer_ = 0;  ///< writer of the last sample, and its participant
  ParticipantId participant_ = kUnknownParticipant;
};

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
    const auto q = quality(topic, options);
    const auto qos = endpoint_qos(q, q.writer_history, options);
    return std::make_unique<CycloneWriter>(endpoint(topic, options, nullptr), publisher_, qos.get());
  }
  std::unique_ptr<detail::Reader> reader(const topics::Description& topic, const EndpointOptions& options,
                                         std::shared_ptr<Doorbell> doorbell) override {
    const Quality q = quality(topic, options);
    const auto qos = endpoint_qos(q, q.reader_history, options);
    return std::make_unique<CycloneReader>(endpoint(topic, options, std::move(doorbell)), subscriber_,
                                           qos.get(), topic.descriptor->m_size);
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

  /// @param doorbell  null for a writer
  std::unique_ptr<Endpoint> endpoint(const topics::Description& topic, const EndpointOptions& options,
                                     std::shared_ptr<Doorbell> doorbell) {
    return std::make_unique<Endpoint>(shared_from_this(), participant_, topic, options, std::move(doorbell));
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
