#include "fastdds/endpoints.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <mutex>
#include <utility>
#include <vector>

#include "crane/bus/cdr.hpp"

namespace crane::bus::fastdds {

namespace dds = eprosima::fastdds::dds;
namespace fastrtps = eprosima::fastrtps;
using namespace std::chrono_literals;

fastrtps::Duration_t duration(std::chrono::nanoseconds time) {
  if (time <= 0ns) return fastrtps::c_TimeInfinite;
  return {static_cast<std::int32_t>(time / 1s), static_cast<std::uint32_t>((time % 1s).count())};
}

namespace {

using fastrtps::types::ReturnCode_t;

template <class EndpointQos>
void translate(EndpointQos& qos, const Quality& quality, bool history, const EndpointOptions& options) {
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = history ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = quality.depth;
  qos.resource_limits().max_instances = quality.instances;
  qos.resource_limits().max_samples_per_instance = quality.depth;
  qos.resource_limits().max_samples = quality.depth * quality.instances;
  qos.resource_limits().allocated_samples = 8;
  qos.deadline().period = duration(options.deadline);
  qos.liveliness().lease_duration = duration(options.liveliness_lease);
  if (options.liveliness_lease > 0ns) {
    qos.liveliness().kind = dds::MANUAL_BY_TOPIC_LIVELINESS_QOS;
    qos.liveliness().announcement_period = duration(options.liveliness_lease / 3);
  }
  qos.endpoint().history_memory_policy = fastrtps::rtps::PREALLOCATED_MEMORY_MODE;
  qos.data_sharing().off();  // the shared memory of a killed process would remain and delay its restart
}

dds::DataWriterQos writer_qos(const Quality& quality, const EndpointOptions& options) {
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  translate(qos, quality, quality.writer_history, options);
  qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  qos.writer_data_lifecycle().autodispose_unregistered_instances = false;
  qos.representation().m_value = {dds::XCDR_DATA_REPRESENTATION};
  qos.reliability().max_blocking_time = duration(10ms);
  qos.reliable_writer_qos().times.heartbeatPeriod = duration(20ms);
  qos.reliable_writer_qos().times.initialHeartbeatDelay = duration(5ms);
  qos.reliable_writer_qos().times.nackResponseDelay = duration(1ms);
  qos.reliable_writer_qos().disable_heartbeat_piggyback = true;
  return qos;
}

dds::DataReaderQos reader_qos(const Quality& quality, const EndpointOptions& options) {
  dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
  translate(qos, quality, quality.reader_history, options);
  qos.type_consistency().representation.m_value = {dds::XCDR_DATA_REPRESENTATION};
  qos.reliable_reader_qos().times.heartbeatResponseDelay = duration(1ms);
  qos.reliable_reader_qos().times.initialAcknackDelay = duration(5ms);
  return qos;
}

class FastWriter final : public detail::Writer, private dds::DataWriterListener {
 public:
  FastWriter(std::shared_ptr<BackEnd> back_end, dds::Publisher& publisher, dds::Topic& topic,
             const topics::Description& description, const EndpointOptions& options)
      : back_end_{std::move(back_end)},
        publisher_{publisher},
        announce_{options.on_event, description.name},
        writer_{publisher.create_datawriter(&topic, writer_qos(quality(description, options), options), this,
                                            dds::StatusMask::all())} {
    if (writer_ == nullptr) throw Error{"Fast DDS: cannot create writer of " + std::string{description.name}};
  }
  FastWriter(const FastWriter&) = delete;
  FastWriter& operator=(const FastWriter&) = delete;
  ~FastWriter() override {
    writer_->set_listener(nullptr);
    publisher_.delete_datawriter(writer_);
  }

  bool write(const void* sample) override { return writer_->write(const_cast<void*>(sample)); }
  bool dispose(const void* sample) override {
    return writer_->dispose(const_cast<void*>(sample), fastrtps::rtps::c_InstanceHandle_Unknown) ==
           ReturnCode_t::RETCODE_OK;
  }
  bool assert_liveliness() override { return writer_->assert_liveliness() == ReturnCode_t::RETCODE_OK; }
  bool wait_until_acknowledged(std::chrono::nanoseconds timeout) override {
    return writer_->wait_for_acknowledgments(duration(timeout)) == ReturnCode_t::RETCODE_OK;
  }
  [[nodiscard]] int matched() const override {
    dds::PublicationMatchedStatus status;
    writer_->get_publication_matched_status(status);
    return status.current_count;
  }

 private:
  void on_publication_matched(dds::DataWriter*, const dds::PublicationMatchedStatus& status) override {
    announce_.matched(status.current_count_change, status.current_count);
  }
  void on_offered_incompatible_qos(dds::DataWriter*,
                                   const dds::OfferedIncompatibleQosStatus& status) override {
    announce_(EventKind::incompatible_qos, 0, policy_name(static_cast<int>(status.last_policy_id)));
  }
  void on_offered_deadline_missed(dds::DataWriter*, const dds::OfferedDeadlineMissedStatus&) override {
    announce_(EventKind::deadline_missed);
  }
  void on_liveliness_lost(dds::DataWriter*, const dds::LivelinessLostStatus&) override {
    announce_(EventKind::liveliness_lost);
  }

  std::shared_ptr<BackEnd> back_end_;
  dds::Publisher& publisher_;
  Announcer announce_;
  dds::DataWriter* writer_;
};

class FastReader final : public detail::Reader, private dds::DataReaderListener {
 public:
  FastReader(std::shared_ptr<BackEnd> back_end, dds::Subscriber& subscriber, dds::Topic& topic,
             const topics::Description& description, const EndpointOptions& options,
             std::shared_ptr<Doorbell> doorbell)
      : back_end_{std::move(back_end)},
        subscriber_{subscriber},
        announce_{options.on_event, description.name},
        doorbell_{std::move(doorbell)},
        codec_{CdrCodec::of(*description.descriptor)},
        reader_{subscriber.create_datareader(&topic, reader_qos(quality(description, options), options), this,
                                             dds::StatusMask::all())} {
    if (reader_ == nullptr) throw Error{"Fast DDS: cannot create reader of " + std::string{description.name}};
  }
  FastReader(const FastReader&) = delete;
  FastReader& operator=(const FastReader&) = delete;
  ~FastReader() override {
    reader_->set_listener(nullptr);
    subscriber_.delete_datareader(reader_);
  }

  bool take(void* sample, SampleInfo& info) override {
    dds::SampleInfo from;
    if (reader_->take_next_sample(sample, &from) != ReturnCode_t::RETCODE_OK) return false;
    info = {.source_time_ns = from.source_timestamp.to_ns(),
            .valid = from.valid_data,
            .disposed = from.instance_state == dds::NOT_ALIVE_DISPOSED_INSTANCE_STATE};
    const auto& guid = from.sample_identity.writer_guid();
    std::copy_n(guid.guidPrefix.value, std::size(guid.guidPrefix.value), info.participant.begin());
    std::ranges::copy(info.participant, info.writer.begin());
    std::copy_n(guid.entityId.value, std::size(guid.entityId.value),
                info.writer.begin() + info.participant.size());
    if (!info.valid) key_from_handle(from.instance_handle, sample);
    return true;
  }
  [[nodiscard]] int matched() const override {
    dds::SubscriptionMatchedStatus status;
    reader_->get_subscription_matched_status(status);
    return status.current_count;
  }
  void matched_writers(std::vector<WriterId>& writers) const override {
    const std::lock_guard lock{mutex_};
    writers = writers_;
  }
  [[nodiscard]] std::string origin_of(const WriterId& writer) const override {
    ParticipantId participant{};
    std::copy_n(writer.begin(), participant.size(), participant.begin());
    return back_end_->origin_of(participant);
  }

 private:
  /// Fast DDS writes no sample when the state of an instance changes. The handle of the instance contains the
  /// key: as RTPS key hash, or, when a Cyclone DDS writer disposed the instance, as key-only payload with its
  /// encapsulation.
  void key_from_handle(const fastrtps::rtps::InstanceHandle_t& handle, void* sample) const {
    constexpr std::array<std::uint8_t, 4> kPlainLittleEndian{0, 1, 0, 0};
    std::memset(sample, 0, codec_.sample_bytes());
    const std::uint8_t* bytes = handle.value;
    std::array<std::uint8_t, 16> key{};
    std::copy_n(bytes, key.size(), key.begin());
    if (std::equal(kPlainLittleEndian.begin(), kPlainLittleEndian.end(), key.begin())) {
      std::copy_n(bytes + 4, 8, key.begin());
      (void)codec_.decode_key(key, false, sample);
    } else {
      (void)codec_.decode_key(key, true, sample);
    }
  }

  void on_data_available(dds::DataReader*) override { doorbell_->ring(announce_.topic); }
  void on_subscription_matched(dds::DataReader*, const dds::SubscriptionMatchedStatus& status) override {
    {
      WriterId writer{};
      const std::uint8_t* const guid = status.last_publication_handle.value;
      std::copy_n(guid, writer.size(), writer.begin());
      const std::lock_guard lock{mutex_};
      std::erase(writers_, writer);
      if (status.current_count_change > 0) writers_.push_back(writer);
    }
    announce_.matched(status.current_count_change, status.current_count);
  }
  void on_requested_incompatible_qos(dds::DataReader*,
                                     const dds::RequestedIncompatibleQosStatus& status) override {
    announce_(EventKind::incompatible_qos, 0, policy_name(static_cast<int>(status.last_policy_id)));
  }
  void on_requested_deadline_missed(dds::DataReader*, const dds::RequestedDeadlineMissedStatus&) override {
    announce_(EventKind::deadline_missed);
  }
  void on_liveliness_changed(dds::DataReader*, const dds::LivelinessChangedStatus& status) override {
    // Fast DDS adds changes in quick succession. The sum is zero when a writer disappears and returns at
    // once.
    const int before = alive_.exchange(status.alive_count);
    if (status.alive_count == before) return;
    const bool gained = status.alive_count > before;
    announce_(gained ? EventKind::liveliness_gained : EventKind::liveliness_lost, status.alive_count);
  }
  void on_sample_lost(dds::DataReader*, const dds::SampleLostStatus& status) override {
    announce_(EventKind::sample_lost, status.total_count);
  }

  std::shared_ptr<BackEnd> back_end_;
  dds::Subscriber& subscriber_;
  Announcer announce_;
  std::shared_ptr<Doorbell> doorbell_;
  const CdrCodec& codec_;
  std::atomic<int> alive_{0};
  mutable std::mutex mutex_;
  std::vector<WriterId> writers_;  ///< matched; Fast DDS 2.9 does not list them
  dds::DataReader* reader_;
};

}  // namespace

std::unique_ptr<detail::Writer> make_writer(std::shared_ptr<BackEnd> back_end, dds::Publisher& publisher,
                                            dds::Topic& topic, const topics::Description& description,
                                            const EndpointOptions& options) {
  return std::make_unique<FastWriter>(std::move(back_end), publisher, topic, description, options);
}

std::unique_ptr<detail::Reader> make_reader(std::shared_ptr<BackEnd> back_end, dds::Subscriber& subscriber,
                                            dds::Topic& topic, const topics::Description& description,
                                            const EndpointOptions& options,
                                            std::shared_ptr<Doorbell> doorbell) {
  return std::make_unique<FastReader>(std::move(back_end), subscriber, topic, description, options,
                                      std::move(doorbell));
}

}  // namespace crane::bus::fastdds
