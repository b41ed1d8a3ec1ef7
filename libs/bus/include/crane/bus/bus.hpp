#pragma once
/// Publishers and subscribers over Cyclone DDS, Fast DDS or an in-process network. The sample type of a topic
/// is the C struct that idlc generates. The generated crane.h includes the type descriptors of Cyclone DDS
/// (dds_public_impl.h). Only src/cyclone, src/fastdds and cdr*.cpp include other vendor headers.
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
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crane/bus/endpoints.hpp"
#include "crane/bus/found_endpoint.hpp"
#include "crane/bus/options.hpp"
#include "crane/topics.hpp"

namespace crane::bus {

/// A participant of the same crane whose program was built with another version of crane.idl.
struct OtherVersion {
  std::string participant;
  std::uint32_t version = 0;  ///< crane::MESSAGES_VERSION of that program
};
/// @return "NAME has messages of version 2, this program has version 1: ...", with the remedy
[[nodiscard]] std::string refusal(const OtherVersion& other,
                                  std::uint32_t own_version = crane_MESSAGES_VERSION);

/// Called when a sample of `topic` has arrived.
using ArrivalHandler = std::function<void(std::string_view topic)>;

/// One DDS participant in one domain, or a share of a participant (share()). The calls of publish, take and
/// wait must not overlap; event handlers run on threads of the vendor. Publishers and subscribers keep the
/// participant alive, and may outlive their Bus.
class Bus {
 public:
  explicit Bus(Options options);  ///< @throws Error
  ~Bus();
  Bus(Bus&&) noexcept;
  Bus& operator=(Bus&&) noexcept;

  /// @return another bus of the same participant, for another component of this process. The new bus has its
  /// own source, start-up number, wait() and arrival handler, and the keys of this bus. Both buses exchange
  /// samples like the buses of two participants.
  [[nodiscard]] Bus share(crane_Source source, std::uint32_t epoch) const;

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

  /// From now on, the bus calls `on_arrival` for each sample that arrives at one of its subscribers, and
  /// wait() sleeps until its timeout. Receive threads of the vendor, which may hold locks, and publishing
  /// threads of this process call `on_arrival`, also at the same time. Two calls must not take or
  /// publish at the same time (crane/runtime/turn.hpp). `on_arrival` must not wait for another
  /// thread, and must not publish `topic`. Reason of the last rule: Cyclone DDS runs one callback
  /// of a reader at a time, and the callback of the new sample would wait for the present one
  /// forever.
  /// @pre no subscriber of this bus exists
  void call_on_arrival(ArrivalHandler on_arrival);

  /// Participants of this crane whose messages have another version. This bus drops all their samples.
  [[nodiscard]] std::vector<OtherVersion> other_versions();
  /// Readers and writers of all other participants of the domain, found by discovery so far. The memory back
  /// end finds none.
  [[nodiscard]] std::vector<FoundEndpoint> found_endpoints();

  [[nodiscard]] const Options& options() const;

 private:
  UntypedPublisher make_publisher(const topics::Description&, const EndpointOptions&);
  UntypedSubscriber make_subscriber(const topics::Description&, const EndpointOptions&);
  struct State;
  explicit Bus(std::unique_ptr<State> state);
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
