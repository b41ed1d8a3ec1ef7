#pragma once
/// The in-process network: connections between writers and readers, and their queues.
#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "back_end.hpp"
#include "memory/history.hpp"

namespace crane::bus::memory {

/// A number that the network writes under its mutex and that endpoints read without the mutex.
class AtomicCount {
 public:
  AtomicCount() = default;
  AtomicCount(AtomicCount&& other) noexcept
      : value_{other.value_.load()} {}  ///< @pre the endpoint is not registered
  AtomicCount& operator=(std::size_t value) {
    value_ = value;
    return *this;
  }
  operator std::size_t() const { return value_; }

 private:
  std::atomic<std::size_t> value_ = 0;
};

/// Topic and quality of service of an endpoint, which determine its connections, and the event handler of the
/// endpoint.
struct Port {
  const topics::Description* topic;
  std::string partition;
  Announcer announce;
  std::uint64_t participant = 0;  ///< number of the bus, unique in the network
  AtomicCount matched{};          ///< number of connected endpoints of the other kind
};
[[nodiscard]] bool connects(const Port& a, const Port& b);

struct ReaderPort;
struct WriterPort : Port {
  History history;
  std::uint32_t messages_version = 0;
  std::uint64_t number = 0;            ///< assigned by the network, unique in the network
  std::vector<ReaderPort*> readers{};  ///< in order of their creation
};
[[nodiscard]] WriterId id_of(const WriterPort& writer);
struct ReaderPort : Port {
  std::shared_ptr<Doorbell> doorbell;
  SampleQueue queue;
  bool wants_history = false;
  AtomicCount queued{};  ///< number of samples in `queue`
  std::vector<WriterPort*> writers{};
};

}  // namespace crane::bus::memory

namespace crane::bus {

/// Thread-safe. Endpoints register themselves at construction and remove themselves at destruction.
class MemoryNetwork {
 public:
  void add(memory::WriterPort& writer);
  void add(memory::ReaderPort& reader);
  void remove(memory::WriterPort& writer);
  void remove(memory::ReaderPort& reader);

  void publish(memory::WriterPort& writer, const void* sample, bool dispose);
  /// Copies the oldest sample to `sample`. @return its stamp; nothing when the queue is empty
  std::optional<memory::Stamp> take(memory::ReaderPort& reader, void* sample);
  void set_wire(Wire wire);
  void writers_of(const memory::ReaderPort& reader, std::vector<WriterId>& writers);
  /// @return 1, 2, ...
  [[nodiscard]] std::uint64_t next_participant();

 private:
  struct MatchEvents;
  std::mutex mutex_;
  Wire wire_;
  std::vector<memory::WriterPort*> writers_;
  std::vector<memory::ReaderPort*> readers_;
  std::uint64_t published_ = 0, writers_so_far_ = 0, participants_so_far_ = 0;
};

}  // namespace crane::bus
