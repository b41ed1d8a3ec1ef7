#pragma once
/// One facade over Cyclone DDS, Fast DDS and an in-process network. The sample type is the C struct idlc
/// makes; vendor headers occur only in src/cyclone and src/fastdds.
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
/// Every sample carries a Header and a CRC-32C: publish() writes source, epoch and CRC, take() hands out
/// only samples whose CRC is right and counts the others.
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "crane/topics.hpp"

namespace crane::bus {

enum class Vendor : std::uint8_t { cyclone, fastdds, memory };
[[nodiscard]] std::string_view to_string(Vendor vendor);
/// @return nothing when `name` is not "cyclone", "fastdds" or "memory"
[[nodiscard]] std::optional<Vendor> vendor_from_string(std::string_view name);

/// Could not join the domain, create an entity or use a type; says what and what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class MemoryNetwork;  ///< the "wire" of in-process stacks; every Bus of one stack shares one

struct Options {
  Vendor vendor = Vendor::cyclone;
  std::uint32_t domain = 0;                          ///< 0..100
  std::string crane = "crane";                       ///< DDS partition: separates cranes in one domain
  std::string participant = "node";                  ///< name shown by DDS tools
  crane_Source source = crane_SOURCE_NONE;           ///< written into every header
  std::uint32_t epoch = 0;                           ///< written into every header
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses to bind to
  std::vector<std::string> peers{};          ///< not empty: unicast discovery of these hosts, no multicast
  std::shared_ptr<MemoryNetwork> network{};  ///< memory only
};

enum class EventKind : std::uint8_t {
  matched,
  unmatched,
  deadline_missed,
  liveliness_lost,
  liveliness_gained,
  incompatible_qos,
  sample_lost
};
[[nodiscard]] std::string_view to_string(EventKind kind);

struct Event {
  EventKind kind;
  std::string_view topic;
  int current = 0;  ///< matched, unmatched: counterparts now; sample_lost: total
  /// incompatible_qos: name of the policy. Cyclone DDS tells of endpoints of other cranes too.
  std::string_view policy;
};
/// Called on a vendor thread: hand over and return.
using EventHandler = std::function<void(const Event&)>;

/// What one endpoint wants beyond its topic's own quality of service.
struct EndpointOptions {
  /// Publisher: keeps what it publishes for readers that come later (loop, script; log and status topics
  /// always do). Subscriber: also takes what was published before it came, from publishers that kept it
  /// (status topics always).
  bool history = false;
  /// Event when no sample came for so long; 0: never. A reader matches only writers that offer as short a
  /// deadline and lease. The memory back end has no clock and tells neither.
  std::chrono::nanoseconds deadline{0};
  /// Manual by topic: publishing asserts it; 0: automatic and infinite.
  std::chrono::nanoseconds liveliness_lease{0};
  EventHandler on_event{};
};

/// Who wrote a sample, as the middleware tells it: equal for all samples of one writer, different for any two
/// writers. Valid within this process. A header can be copied by anybody; this cannot be chosen by its sender
/// as long as the sender uses a DDS implementation.
using WriterId = std::array<std::uint8_t, 16>;

struct SampleInfo {
  std::int64_t source_time_ns = 0;  ///< writer's clock; memory: the header's sample_time_ns
  bool valid = false;               ///< false: only the instance's state changed
  bool disposed = false;
  WriterId writer{};
};

/// Counted since creation.
struct ReaderCounts {
  std::uint64_t taken = 0;
  std::uint64_t rejected = 0;  ///< wrong CRC: never handed out
};

/// Type-erased back end; implemented once per vendor.
namespace detail {
class Writer {
 public:
  virtual ~Writer() = default;
  virtual bool write(const void* sample) = 0;
  virtual bool dispose(const void* sample) = 0;
  virtual bool assert_liveliness() = 0;
  [[nodiscard]] virtual int matched() const = 0;
};
class Reader {
 public:
  virtual ~Reader() = default;
  /// Copies the oldest sample not yet taken. @return false when there is none
  virtual bool take(void* sample, SampleInfo& info) = 0;
  [[nodiscard]] virtual int matched() const = 0;
};
/// Adds source, epoch and CRC in place. The CRC covers the topic's name, too: a sample carried over to
/// another topic of the same type is not intact.
void seal(const topics::Description& topic, void* sample, crane_Source source, std::uint32_t epoch);
[[nodiscard]] bool intact(const topics::Description& topic, const void* sample);
}  // namespace detail

template <class T>
class Publisher {
  static_assert(std::is_trivially_copyable_v<T>, "topics have fixed-size fields and bounded strings only");

 public:
  Publisher(const topics::Description& topic, std::unique_ptr<detail::Writer> writer, crane_Source source,
            std::uint32_t epoch)
      : topic_{&topic}, writer_{std::move(writer)}, source_{source}, epoch_{epoch} {}

  /// Fills in source, epoch and CRC of `sample` and sends it. @return false when the vendor refused
  [[nodiscard]] bool publish(T sample) {
    detail::seal(*topic_, &sample, source_, epoch_);
    return writer_->write(&sample);
  }
  [[nodiscard]] bool dispose(const T& sample) { return writer_->dispose(&sample); }
  [[nodiscard]] bool assert_liveliness() { return writer_->assert_liveliness(); }
  /// Readers matched now.
  [[nodiscard]] int matched() const { return writer_->matched(); }

 private:
  const topics::Description* topic_;
  std::unique_ptr<detail::Writer> writer_;
  crane_Source source_;
  std::uint32_t epoch_;
};

template <class T>
class Subscriber {
 public:
  Subscriber(const topics::Description& topic, std::unique_ptr<detail::Reader> reader)
      : topic_{&topic}, reader_{std::move(reader)} {}

  /// The oldest intact sample not yet taken; nothing when there is none. Samples without data (an instance
  /// was disposed) are passed over unless `info` is given, then `info->valid` is false.
  std::optional<T> take(SampleInfo* info = nullptr) {
    T sample{};
    SampleInfo local;
    while (reader_->take(&sample, local)) {
      if (local.valid && !detail::intact(*topic_, &sample)) {
        ++counts_.rejected;
        continue;
      }
      if (!local.valid && info == nullptr) continue;
      if (info != nullptr) *info = local;
      if (local.valid) ++counts_.taken;
      return sample;
    }
    return std::nullopt;
  }
  /// Writers matched now.
  [[nodiscard]] int matched() const { return reader_->matched(); }
  [[nodiscard]] const ReaderCounts& counts() const { return counts_; }

 private:
  const topics::Description* topic_;
  std::unique_ptr<detail::Reader> reader_;
  ReaderCounts counts_;
};

/// A reader of any topic, for tools: hands out plain-CDR bytes (little endian, with the 4-byte encapsulation
/// header), as recordings store them.
class CdrSubscriber {
 public:
  CdrSubscriber(const topics::Description& topic, std::unique_ptr<detail::Reader> reader);
  /// @return header of the next intact sample, its bytes in `cdr`; nothing when there is none
  std::optional<msg::Header> take(std::vector<std::uint8_t>& cdr, SampleInfo* info = nullptr);
  [[nodiscard]] int matched() const { return reader_->matched(); }
  [[nodiscard]] const ReaderCounts& counts() const { return counts_; }
  [[nodiscard]] const topics::Description& topic() const { return *topic_; }

 private:
  const topics::Description* topic_;
  std::unique_ptr<detail::Reader> reader_;
  ReaderCounts counts_;
  std::vector<std::uint8_t> sample_;
};

/// One participant in one domain. Threads: publish, take and wait belong to one thread, events come on
/// others. Publishers and subscribers keep the participant alive: they may outlive their Bus.
class Bus {
 public:
  explicit Bus(Options options);  ///< @throws Error
  ~Bus();
  Bus(Bus&&) noexcept;
  Bus& operator=(Bus&&) noexcept;

  template <class T>
  [[nodiscard]] Publisher<T> publisher(const topics::Topic<T>& topic, const EndpointOptions& endpoint = {}) {
    return {topic.description, make_writer(topic.description, endpoint), options().source, options().epoch};
  }
  template <class T>
  [[nodiscard]] Subscriber<T> subscriber(const topics::Topic<T>& topic,
                                         const EndpointOptions& endpoint = {}) {
    return {topic.description, make_reader(topic.description, endpoint)};
  }
  [[nodiscard]] CdrSubscriber cdr_subscriber(const topics::Description& topic,
                                             const EndpointOptions& endpoint = {});

  /// Sleeps until a sample has arrived on any subscriber of this bus since the last call, or the time is up.
  /// @return true when something arrived (or had arrived before the call)
  bool wait(std::chrono::nanoseconds timeout);

  [[nodiscard]] const Options& options() const;

 private:
  std::unique_ptr<detail::Writer> make_writer(const topics::Description&, const EndpointOptions&);
  std::unique_ptr<detail::Reader> make_reader(const topics::Description&, const EndpointOptions&);
  struct State;
  std::unique_ptr<State> state_;
};

/// A new, empty in-process network.
[[nodiscard]] std::shared_ptr<MemoryNetwork> make_memory_network();

/// Hands a sample of the topic to all its readers.
using Deliver = std::function<void(const void* sample)>;
/// What an in-process network does to a published sample: calls `deliver` once for every sample that arrives,
/// this one or any other of its topic. It must not use the network.
using Wire =
    std::function<void(const topics::Description& topic, const void* sample, const Deliver& deliver)>;
/// From now on samples go through `wire`; an empty one delivers each sample once.
void set_wire(MemoryNetwork& network, Wire wire);

}  // namespace crane::bus
