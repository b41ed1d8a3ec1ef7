#include "memory/network.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cstring>

namespace crane::bus {

using memory::ReaderPort;
using memory::Stamp;
using memory::WriterPort;

namespace memory {
namespace {
bool fits(const std::string& pattern, const std::string& name) {
  return fnmatch(pattern.c_str(), name.c_str(), FNM_NOESCAPE) == 0;
}
}  // namespace

WriterId id_of(const WriterPort& writer) {
  WriterId id{};
  std::memcpy(id.data(), &writer.number, sizeof writer.number);
  return id;
}

bool connects(const Port& a, const Port& b) {
  return a.topic->name == b.topic->name && a.topic->descriptor == b.topic->descriptor &&
         (fits(a.partition, b.partition) || fits(b.partition, a.partition));
}
}  // namespace memory

/// Events are collected under the lock and reported after its release, because a handler may call the bus.
struct MemoryNetwork::MatchEvents {
  struct Item {
    Announcer announce;
    int change;
    int current;
  };
  std::vector<Item> items;
  /// Stores the number of `peers`, the endpoints connected to `port`, and queues the call of its event
  /// handler. Call after each change of `peers`.
  template <class Peers>
  void add(memory::Port& port, int change, const Peers& peers) {
    port.matched = peers.size();
    if (port.announce.handler) items.push_back({port.announce, change, static_cast<int>(peers.size())});
  }
  void report() const {
    for (const Item& item : items) item.announce.matched(item.change, item.current);
  }
};

void MemoryNetwork::add(WriterPort& writer) {
  MatchEvents events;
  {
    const std::lock_guard lock{mutex_};
    writer.number = ++writers_so_far_;
    writers_.push_back(&writer);
    for (ReaderPort* reader : readers_) {
      if (!connects(writer, *reader)) continue;
      writer.readers.push_back(reader);
      reader->writers.push_back(&writer);
      events.add(writer, +1, writer.readers);
      events.add(*reader, +1, reader->writers);
    }
  }
  events.report();
}

void MemoryNetwork::add(ReaderPort& reader) {
  MatchEvents events;
  {
    const std::lock_guard lock{mutex_};
    readers_.push_back(&reader);
    std::vector<std::pair<const void*, Stamp>> past;
    for (WriterPort* writer : writers_) {
      if (!connects(*writer, reader)) continue;
      writer->readers.push_back(&reader);
      reader.writers.push_back(writer);
      events.add(*writer, +1, writer->readers);
      events.add(reader, +1, reader.writers);
      if (reader.wants_history)
        writer->history.each(
            [&](const void* sample, const Stamp& stamp) { past.emplace_back(sample, stamp); });
    }
    std::sort(past.begin(), past.end(),
              [](const auto& a, const auto& b) { return a.second.order < b.second.order; });
    for (const auto& [sample, stamp] : past) reader.queue.push(sample, stamp);
    reader.queued = reader.queue.size();
    if (!past.empty()) reader.doorbell->ring();
  }
  events.report();
}

void MemoryNetwork::remove(WriterPort& writer) {
  MatchEvents events;
  {
    const std::lock_guard lock{mutex_};
    std::erase(writers_, &writer);
    for (ReaderPort* reader : writer.readers) {
      std::erase(reader->writers, &writer);
      events.add(*reader, -1, reader->writers);
    }
  }
  events.report();
}

void MemoryNetwork::remove(ReaderPort& reader) {
  MatchEvents events;
  {
    const std::lock_guard lock{mutex_};
    std::erase(readers_, &reader);
    for (WriterPort* writer : reader.writers) {
      std::erase(writer->readers, &reader);
      events.add(*writer, -1, writer->readers);
    }
  }
  events.report();
}

void MemoryNetwork::writers_of(const ReaderPort& reader, std::vector<WriterId>& writers) {
  const std::lock_guard lock{mutex_};
  writers.clear();
  for (const WriterPort* writer : reader.writers) writers.push_back(memory::id_of(*writer));
}

void MemoryNetwork::publish(WriterPort& writer, const void* sample, bool dispose) {
  // The source time is the time of the plant, the only clock of an in-process stack. Two runs are therefore
  // equal bit for bit.
  const auto time_ns = static_cast<const msg::Header*>(sample)->sample_time_ns;
  const std::lock_guard lock{mutex_};
  Stamp stamp{++published_, {.source_time_ns = time_ns, .valid = !dispose, .disposed = dispose}};
  stamp.info.writer = memory::id_of(writer);
  std::memcpy(stamp.info.participant.data(), &writer.participant, sizeof writer.participant);
  if (!wire_) stamp.sealed_for = writer.messages_version;
  const auto deliver = [&](const void* arriving) {
    for (ReaderPort* reader : writer.readers) {
      reader->queue.push(arriving, stamp);
      reader->queued = reader->queue.size();
      reader->doorbell->ring();
    }
  };
  if (wire_ && !dispose)
    wire_(*writer.topic, sample, deliver);
  else
    deliver(sample);
  if (dispose)
    writer.history.forget(sample);
  else
    writer.history.keep(sample, stamp);
}

std::optional<Stamp> MemoryNetwork::take(ReaderPort& reader, void* sample) {
  if (reader.queued == 0) return std::nullopt;
  const std::lock_guard lock{mutex_};
  std::memcpy(sample, reader.queue.sample(0), reader.topic->descriptor->m_size);
  const Stamp stamp = reader.queue.stamp(0);
  reader.queue.pop();
  reader.queued = reader.queue.size();
  return stamp;
}

std::uint64_t MemoryNetwork::next_participant() {
  const std::lock_guard lock{mutex_};
  return ++participants_so_far_;
}

void MemoryNetwork::set_wire(Wire wire) {
  const std::lock_guard lock{mutex_};
  wire_ = std::move(wire);
}

void set_wire(MemoryNetwork& network, Wire wire) { network.set_wire(std::move(wire)); }

std::shared_ptr<MemoryNetwork> make_memory_network() { return std::make_shared<MemoryNetwork>(); }

}  // namespace crane::bus
