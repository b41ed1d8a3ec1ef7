#include "cyclone/endpoints.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "cyclone/domain.hpp"

namespace crane::bus::cyclone {
namespace {

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
  bool wait_until_acknowledged(std::chrono::nanoseconds timeout) override {
    return dds_wait_for_acks(writer_, timeout.count()) == DDS_RETCODE_OK;
  }
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

}  // namespace

std::unique_ptr<detail::Writer> make_writer(std::shared_ptr<BackEnd> back_end, dds_entity_t participant,
                                            dds_entity_t group, const topics::Description& description,
                                            const EndpointOptions& options) {
  const Quality q = quality(description, options);
  const auto qos = endpoint_qos(q, q.writer_history, options);
  auto endpoint = std::make_unique<Endpoint>(std::move(back_end), participant, description, options, nullptr);
  return std::make_unique<CycloneWriter>(std::move(endpoint), group, qos.get());
}

std::unique_ptr<detail::Reader> make_reader(std::shared_ptr<BackEnd> back_end, dds_entity_t participant,
                                            dds_entity_t group, const topics::Description& description,
                                            const EndpointOptions& options,
                                            std::shared_ptr<Doorbell> doorbell) {
  const Quality q = quality(description, options);
  const auto qos = endpoint_qos(q, q.reader_history, options);
  auto endpoint =
      std::make_unique<Endpoint>(std::move(back_end), participant, description, options, std::move(doorbell));
  return std::make_unique<CycloneReader>(std::move(endpoint), group, qos.get(),
                                         description.descriptor->m_size);
}

}  // namespace crane::bus::cyclone
