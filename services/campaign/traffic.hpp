#pragma once
/// Faults of samples between a component and the bus, and foreign writers.
#include <cstddef>
#include <cstring>
#include <vector>

#include "campaign/bench.hpp"

namespace crane::campaign {

/// A wire that applies `fault` to one topic and delivers all other topics.
[[nodiscard]] bus::Wire on(const topics::Description& topic,
                           std::function<void(const void* sample, const bus::Deliver& deliver)> fault);

/// A sample that the wire stores.
class StoredSample {
 public:
  explicit StoredSample(const topics::Description& topic);
  void keep(const void* sample);
  [[nodiscard]] bool full() const { return full_; }
  [[nodiscard]] const void* look() const { return bytes_.data(); }
  [[nodiscard]] const void* take();
  void flip(std::size_t bit);
  /// Changes the voltage of `axis`, or the trolley position: the most dangerous effect of a wrong bit.
  void change_value(std::size_t axis);
  /// Gives the sample a correct CRC.
  void seal();

 private:
  const topics::Description& topic_;
  std::vector<std::max_align_t> bytes_;
  bool full_ = false;
};

/// Changes the samples of one topic before they get their CRC.
template <class T, class Change>
[[nodiscard]] PublishFault falsify(const topics::Topic<T>& topic, Change change) {
  return [&topic, change = std::move(change)](const topics::Description& published, void* sample) mutable {
    if (published.name != topic.description.name) return false;
    change(*static_cast<T*>(sample));
    return true;
  };
}

/// Kind of process that may write a loop topic in this stack.
[[nodiscard]] crane_Source right_source(const topics::Description& topic);

/// A foreign program in the domain.
class ForeignWriter {
 public:
  ForeignWriter(Bench& bench, crane_Source source, std::uint32_t epoch);
  /// Publishes one plausible sample of a loop topic.
  void publish_plausible(const topics::Description& topic, const Bench& bench);
  /// @param later  true: requests for later ticks; false: requests that are due at once
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
