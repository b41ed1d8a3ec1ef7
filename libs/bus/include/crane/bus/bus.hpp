#pragma once
/// Publishers and subscribers over Cyclone DDS, Fast DDS or an in-process network. The sample type of a topic
/// is the C struct that idlc generates. Vendor headers are included in src/cyclone and src/fastdds only.
///
///   bus::Bus bus{options};
///   auto states = bus.subscriber(topics::state);
///   auto commands = bus.publisher(topics::command);
///   while (!stop) {
///     bus.wait(10ms);
///     while (auto sample = states.take())
///       if (!commands.publish(answer(*sample))) ++refused;
///   }
///
/// Every sample carries a Header and a CRC-32C. publish() writes source, epoch and CRC. take() returns only
/// samples with a correct CRC, and counts the rejected ones. Samples of programs with another version of
/// crane.idl have a wrong CRC; Bus::other_versions() names these programs. Texts of taken samples are
/// printable (crane/fields/printable.hpp): a program on the bus cannot control the terminal of another
/// program.
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus {

enum class Vendor : std::uint8_t { cyclone, fastdds, memory };
[[nodiscard]] std::string_view to_string(Vendor vendor);
/// @return nothing when `name` is not "cyclone", "fastdds" or "memory"
[[nodiscard]] std::optional<Vendor> vendor_from_string(std::string_view name);

/// The bus cannot join the domain, create an entity or use a type. what() names the cause and the remedy.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class MemoryNetwork;  ///< connects the buses of an in-process stack; all buses of one stack share one network

/// Absolute paths of one participant's files for DDS Security: PEM; documents signed as S/MIME.
struct Credentials {
  std::string identity_ca, identity_certificate, private_key;
  std::string permissions_ca, governance, permissions;
};

struct Options {
  Vendor vendor = Vendor::cyclone;
  std::uint32_t domain = 0;                          ///< 0..100
  std::string crane = "crane";                       ///< DDS partition: separates cranes in one domain
  std::string participant = "node";                  ///< name that DDS tools show
  crane_Source source = crane_SOURCE_NONE;           ///< Header.source of every published sample
  std::uint32_t epoch = 0;                           ///< Header.epoch of every published sample
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses to bind to
  std::vector<std::string> peers{};          ///< not empty: unicast discovery of these hosts, no multicast
  std::shared_ptr<MemoryNetwork> network{};  ///< Vendor::memory only
  /// Empty: DDS Security is off, and every program that reaches this bus may write to it. The memory back end
  /// needs no credentials.
  std::optional<Credentials> credentials{};
  /// Announced to all participants and part of every CRC. Only tests set another value.
  std::uint32_t messages_version = crane_MESSAGES_VERSION;
};

enum class EventKind : std::uint8_t {
  matched,            ///< a counterpart (reader or writer) was discovered
  unmatched,          ///< a counterpart ended or is no longer reachable
  deadline_missed,    ///< no sample within EndpointOptions::deadline
  liveliness_lost,    ///< a writer has not asserted its liveliness within its lease
  liveliness_gained,  ///< a writer is alive again
  incompatible_qos,   ///< a counterpart was found, but its quality of service does not match
  sample_lost         ///< the middleware lost a sample
};
[[nodiscard]] std::string_view to_string(EventKind kind);

struct Event {
  EventKind kind;
  std::string_view topic;
  int current = 0;  ///< matched, unmatched: number of counterparts; sample_lost: total number of lost samples
  /// incompatible_qos: name of the policy. Cyclone DDS also reports endpoints of other partitions (cranes).
  std::string_view policy;
};
/// Runs on a vendor thread, and must not block.
using EventHandler = std::function<void(const Event&)>;

/// Quality of service of one endpoint beyond that of its topic.
struct EndpointOptions {
  /// Publisher: keeps its samples for late-joining readers (loop and script topics; publishers of log and
  /// status topics always do). Subscriber: also receives samples that were published before it joined, from
  /// publishers that kept them (subscribers of status topics always do).
  bool history = false;
  /// EventKind::deadline_missed when no sample arrives for this time; 0: no deadline. A reader matches only
  /// writers that offer a deadline and a lease at least as short. The memory back end has no clock and
  /// reports neither.
  std::chrono::nanoseconds deadline{0};
  /// Liveliness "manual by topic": publishing asserts it; 0: automatic, with an infinite lease.
  std::chrono::nanoseconds liveliness_lease{0};
  EventHandler on_event{};
};

/// Identifies the DDS writer of a sample: equal for all samples of one writer, different for any two writers.
/// Valid within this process. The middleware assigns the identifier; a sender that uses a DDS implementation
/// cannot choose it. A Header, in contrast, can be copied by any sender.
using WriterId = std::array<std::uint8_t, 16>;

/// Identifies the DDS participant of a writer: equal for all writers of one Bus, different for any two buses.
/// The middleware assigns it; over DDS it is the GUID prefix.
using ParticipantId = std::array<std::uint8_t, 12>;
/// The writer has ended before its sample was taken: its participant cannot be determined.
inline constexpr ParticipantId kUnknownParticipant{};

struct SampleInfo {
  std::int64_t source_time_ns = 0;  ///< clock of the writer; memory: Header.sample_time_ns
  bool valid = false;               ///< false: the sample has no data, only the state of its instance changed
  bool disposed = false;            ///< true: the writer disposed the instance
  WriterId writer{};
  ParticipantId participant = kUnknownParticipant;
};

/// Counts since the creation of the reader.
struct ReaderCounts {
  std::uint64_t taken = 0;     ///< intact samples that take() returned
  std::uint64_t rejected = 0;  ///< samples dropped for a wrong CRC
};

/// A participant of the same crane whose program was built with another version of crane.idl.
struct OtherVersion {
  std::string participant;
  std::uint32_t version = 0;  ///< crane::MESSAGES_VERSION of that program
};
/// @return "NAME has messages of version 2, this program has version 1: ...", with the remedy
[[nodiscard]] std::string refusal(const OtherVersion& other,
                                  std::uint32_t own_version = crane_MESSAGES_VERSION);

namespace detail {
class Writer;  ///< writer of one vendor
class Reader;
}  // namespace detail

/// Part of a publisher that does not depend on the type of its samples.
class UntypedPublisher {
 public:
  UntypedPublisher(const topics::Description& topic, std::unique_ptr<detail::Writer> writer,
                   const Options& options);
  ~UntypedPublisher();
  UntypedPublisher(UntypedPublisher&&) noexcept;
  UntypedPublisher& operator=(UntypedPublisher&&) noexcept;

  [[nodiscard]] bool assert_liveliness();
  /// Number of matched readers.
  [[nodiscard]] int matched() const;

 protected:
  [[nodiscard]] bool send(void* sample);
  [[nodiscard]] bool dispose_of(const void* sample);

 private:
  const topics::Description* topic_;
  std::unique_ptr<detail::Writer> writer_;
  crane_Source source_;
  std::uint32_t epoch_, messages_version_;
};

template <class T>
class Publisher : public UntypedPublisher {
  static_assert(std::is_trivially_copyable_v<T>, "topics have fixed-size fields and bounded strings only");

 public:
  explicit Publisher(UntypedPublisher&& untyped) : UntypedPublisher{std::move(untyped)} {}
  /// Sets source, epoch and CRC of `sample` and sends it. @return false when the middleware did not send it
  [[nodiscard]] bool publish(T sample) { return send(&sample); }
  [[nodiscard]] bool dispose(const T& sample) { return dispose_of(&sample); }
};

/// Writer of any topic, for tools. It publishes the plain-CDR bytes that recordings store.
class CdrPublisher : public UntypedPublisher {
 public:
  CdrPublisher(const topics::Description& topic, UntypedPublisher&& untyped);
  /// Sets source, epoch and CRC of the sample and sends it. @param cdr  little endian, with the 4-byte
  /// encapsulation header
  /// @return false when `cdr` is no sample of the topic, or when the middleware did not send it
  [[nodiscard]] bool publish(std::span<const std::uint8_t> cdr);
  [[nodiscard]] const topics::Description& topic() const { return *topic_; }

 private:
  const topics::Description* topic_;
  std::vector<std::uint8_t> sample_;
};

/// Part of a subscriber that does not depend on the type of its samples.
class UntypedSubscriber {
 public:
  UntypedSubscriber(const topics::Description& topic, std::unique_ptr<detail::Reader> reader,
                    const Options& options);
  ~UntypedSubscriber();
  UntypedSubscriber(UntypedSubscriber&&) noexcept;
  UntypedSubscriber& operator=(UntypedSubscriber&&) noexcept;

  /// Number of matched writers.
  [[nodiscard]] int matched() const;
  [[nodiscard]] const ReaderCounts& counts() const { return counts_; }
  [[nodiscard]] const topics::Description& topic() const { return *topic_; }

 protected:
  /// Copies the oldest intact sample that was not yet taken to `sample`. @return false when there is none
  [[nodiscard]] bool receive(void* sample, SampleInfo* info);

 private:
  void make_printable(void* sample) const;
  const topics::Description* topic_;
  bool has_texts_;
  std::unique_ptr<detail::Reader> reader_;
  std::uint32_t messages_version_;
  ReaderCounts counts_;
};

template <class T>
class Subscriber : public UntypedSubscriber {
 public:
  explicit Subscriber(UntypedSubscriber&& untyped) : UntypedSubscriber{std::move(untyped)} {}
  /// @return the oldest intact sample that was not yet taken; nothing when there is none. A sample without
  ///   data (its instance was disposed) is returned only when `info` is given; `info->valid` is then false
  std::optional<T> take(SampleInfo* info = nullptr) {
    std::optional<T> sample{std::in_place};
    if (!receive(&*sample, info)) sample.reset();
    return sample;
  }
  /// Takes a sample like take(), without a copy: overwrites `sample`.
  /// @return false when there is no sample; `sample` then has no defined value
  [[nodiscard]] bool take_into(T& sample, SampleInfo* info = nullptr) { return receive(&sample, info); }
};

/// Reader of any topic, for tools. It returns plain-CDR bytes (little endian, with the 4-byte encapsulation
/// header), in the form in which recordings store them.
class CdrSubscriber : public UntypedSubscriber {
 public:
  explicit CdrSubscriber(UntypedSubscriber&& untyped);
  /// Writes the bytes of the next intact sample to `cdr`. @return its header; nothing when there is no sample
  std::optional<msg::Header> take(std::vector<std::uint8_t>& cdr, SampleInfo* info = nullptr);

 private:
  std::vector<std::uint8_t> sample_;
};

/// A sample of the topic with this name has arrived.
using ArrivalHandler = std::function<void(std::string_view topic)>;

/// One DDS participant in one domain. The calls of publish, take and wait must not overlap; event handlers
/// run on threads of the vendor. Publishers and subscribers keep the participant alive, and may outlive their
/// Bus.
class Bus {
 public:
  explicit Bus(Options options);  ///< @throws Error
  ~Bus();
  Bus(Bus&&) noexcept;
  Bus& operator=(Bus&&) noexcept;

  template <class T>
  [[nodiscard]] Publisher<T> publisher(const topics::Topic<T>& topic, const EndpointOptions& endpoint = {}) {
    return Publisher<T>{make_publisher(topic.description, endpoint)};
  }
  template <class T>
  [[nodiscard]] Subscriber<T> subscriber(const topics::Topic<T>& topic,
                                         const EndpointOptions& endpoint = {}) {
    return Subscriber<T>{make_subscriber(topic.description, endpoint)};
  }
  [[nodiscard]] CdrPublisher cdr_publisher(const topics::Description& topic,
                                           const EndpointOptions& endpoint = {});
  [[nodiscard]] CdrSubscriber cdr_subscriber(const topics::Description& topic,
                                             const EndpointOptions& endpoint = {});

  /// Sleeps until a sample arrives at any subscriber of this bus, or until the timeout. Returns at once when
  /// a sample has arrived since the last call. @return true when a sample has arrived since the last call
  bool wait(std::chrono::nanoseconds timeout);

  /// From now on, `on_arrival` is called whenever a sample of `topic` has arrived at a subscriber of this
  /// bus, and wait() sleeps until its timeout. The calling thread is a receive thread of the vendor, or a
  /// thread of this process that publishes. The calling thread may hold locks of the vendor, and several
  /// threads may call at the same time. `on_arrival` may take samples and publish other topics. It must not
  /// wait for another thread. It must not publish `topic`: Cyclone DDS runs one callback of a reader at a
  /// time, and the callback of the new sample would wait for the present one forever. Call while no
  /// subscriber of this bus exists.
  void call_on_arrival(ArrivalHandler on_arrival);

  /// Participants of this crane whose messages have another version. This bus drops all their samples.
  [[nodiscard]] std::vector<OtherVersion> other_versions();

  [[nodiscard]] const Options& options() const;

 private:
  UntypedPublisher make_publisher(const topics::Description&, const EndpointOptions&);
  UntypedSubscriber make_subscriber(const topics::Description&, const EndpointOptions&);
  struct State;
  std::unique_ptr<State> state_;
};

/// @return an in-process network without endpoints
[[nodiscard]] std::shared_ptr<MemoryNetwork> make_memory_network();

/// Delivers a sample of the topic to all its readers.
using Deliver = std::function<void(const void* sample)>;
/// Decides which samples an in-process network delivers for a published sample: calls `deliver` once for each
/// sample to deliver. A delivered sample may be the published sample or any other sample of its topic. The
/// function must not use the network.
using Wire =
    std::function<void(const topics::Description& topic, const void* sample, const Deliver& deliver)>;
/// Passes all samples that are published from now on through `wire`. An empty `wire` delivers each sample
/// once.
void set_wire(MemoryNetwork& network, Wire wire);

}  // namespace crane::bus
