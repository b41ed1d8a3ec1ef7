#pragma once
/// Two buses of any vendors in one domain, separated from all other tests on this host.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <vector>

#include "crane/bus/bus.hpp"

namespace crane::bus::testing {

using namespace std::chrono_literals;

/// Longest wait for an event that must occur. A passing test waits for the event only.
constexpr std::chrono::seconds kPatience{10};

inline Options options(Vendor vendor, std::uint32_t domain, const std::string& crane = "crane") {
  static const auto network = make_memory_network();
  return {.vendor = vendor,
          .domain = domain,
          .crane = crane == "*" ? crane : crane + "_" + std::to_string(getpid()),  // tests run side by side
          .source = crane_SOURCE_PLANT,
          .epoch = 11,
          .network = network};
}

/// Calls `condition` when a sample arrives at `bus`, and at least every few milliseconds.
template <class Condition>
[[nodiscard]] bool eventually(Bus& bus, const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    bus.wait(2ms);
  }
  return true;
}

template <class Writer, class Reader>
[[nodiscard]] bool matched(Bus& bus, const Writer& writer, const Reader& reader, int count = 1) {
  return eventually(bus, [&] { return writer.matched() >= count && reader.matched() >= count; });
}

/// Waits for the next sample of `reader`.
template <class T>
std::optional<T> next(Bus& bus, Subscriber<T>& reader, SampleInfo* info = nullptr) {
  std::optional<T> sample;
  (void)eventually(bus, [&] { return (sample = reader.take(info)).has_value(); });
  return sample;
}

/// Collects events from vendor threads.
class Log {
 public:
  EventHandler handler() {
    return [this](const Event& event) {
      const std::lock_guard lock{mutex_};
      events_.push_back(event);
      arrived_.notify_all();
    };
  }
  /// Waits for the `nth` event of this kind. @return the event
  std::optional<Event> wait_for(EventKind kind, std::size_t nth = 1) {
    std::unique_lock lock{mutex_};
    std::optional<Event> found;
    arrived_.wait_for(lock, kPatience, [&] {
      std::size_t seen = 0;
      for (const Event& event : events_)
        if (event.kind == kind && ++seen == nth) found = event;
      return found.has_value();
    });
    return found;
  }
  /// Waits for incompatible_qos with this policy. Other policies may come from parallel tests, because
  /// Cyclone DDS also compares endpoints in different partitions.
  bool wait_for_refusal(std::string_view policy) {
    std::unique_lock lock{mutex_};
    return arrived_.wait_for(lock, kPatience, [&] {
      return std::any_of(events_.begin(), events_.end(), [&](const Event& event) {
        return event.kind == EventKind::incompatible_qos && event.policy == policy;
      });
    });
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Event> events_;
};

struct VendorPair {
  Vendor writer, reader;
};
inline std::string name_of(const VendorPair& pair) {
  return std::string{to_string(pair.writer)} + "_to_" + std::string{to_string(pair.reader)};
}
inline std::ostream& operator<<(std::ostream& out, const VendorPair& pair) { return out << name_of(pair); }
inline const auto kAllPairs = ::testing::Values(
    VendorPair{Vendor::cyclone, Vendor::cyclone}, VendorPair{Vendor::cyclone, Vendor::fastdds},
    VendorPair{Vendor::fastdds, Vendor::cyclone}, VendorPair{Vendor::fastdds, Vendor::fastdds});

}  // namespace crane::bus::testing
