#pragma once
/// What can happen to samples between a component and the bus, and who else may talk there.
#include <cstddef>
#include <cstring>
#include <vector>

#include "campaign/bench.hpp"

namespace crane::campaign {

/// A wire that does `fault` to one topic and leaves the others alone.
[[nodiscard]] bus::Wire on(const topics::Description& topic,
                           std::function<void(const void* sample, const bus::Deliver& deliver)> fault);

/// A sample kept by the wire.
class Held {
 public:
  explicit Held(const topics::Description& topic);
  void keep(const void* sample);
  [[nodiscard]] bool full() const { return full_; }
  [[nodiscard]] const void* look() const { return bytes_.data(); }
  [[nodiscard]] const void* take();
  void flip(std::size_t bit);
  /// Another voltage, or another position: what a wrong bit does at its worst.
  void spoil_value(std::size_t axis);

 private:
  const topics::Description& topic_;
  std::vector<std::max_align_t> bytes_;
  bool full_ = false;
};

/// A component that has gone mad: it publishes something else, with a right CRC.
template <class T, class Change>
[[nodiscard]] Madness madness(const topics::Topic<T>& topic, Change change) {
  return [&topic, change = std::move(change)](const topics::Description& published, void* sample) mutable {
    if (published.name != topic.description.name) return false;
    change(*static_cast<T*>(sample));
    return true;
  };
}

/// The kind of process that writes a loop topic in this stack.
[[nodiscard]] crane_Source right_source(const topics::Description& topic);

/// A program that has joined the domain.
class Stranger {
 public:
  Stranger(Bench& bench, crane_Source source, std::uint32_t epoch);
  /// One sample of a loop topic, as plausible as it can be made.
  void speak(const topics::Description& topic, const Bench& bench);
  /// @param later  for ticks to come; otherwise to be answered at once
  void flood_requests(const Bench& bench, std::size_t count, bool later);

 private:
  template <class T>
  void publish(const topics::Topic<T>& topic, T sample);
  bus::Bus bus_;
  std::uint64_t next_id_ = 1;
  std::optional<bus::Publisher<msg::State>> states_;
  std::optional<bus::Publisher<msg::Reference>> references_;
  std::optional<bus::Publisher<msg::Contribution>> tracking_, anti_swing_;
  std::optional<bus::Publisher<msg::Demand>> demands_;
  std::optional<bus::Publisher<msg::Command>> commands_;
  std::optional<bus::Publisher<msg::Request>> requests_;
};

}  // namespace crane::campaign
