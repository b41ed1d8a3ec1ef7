#pragma once
/// Which parts of what is heard have to be kept: around every stop, fault and trip, from 10 s before its
/// first cause to 5 s after its last note. Moments that overlap are one. Pure; bounded memory.
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "observation/fault_timeline.hpp"

namespace crane::black_box {

using observation::FaultTimeline;
using observation::History;
using observation::SamplePtr;

struct Moment {
  std::int64_t from_ns = 0, until_ns = 0;  ///< log time
  observation::Note first;                 ///< its first cause
  std::size_t faults = 0;                  ///< number of faults that were merged
  std::vector<SamplePtr> samples;          ///< of every topic, in the order of log time
};

class Moments {
 public:
  static constexpr std::int64_t kBefore_ns = FaultTimeline::kBefore_ns, kAfter_ns = FaultTimeline::kAfter_ns;
  /// A crane that trips without an end gives a file each minute.
  static constexpr std::int64_t kLongest_ns = 60'000'000'000;
  static constexpr std::int64_t kKept_ns = kBefore_ns + kLongest_ns + kAfter_ns;

  /// @param started_ns  what happened before is known from the events of others, and not kept
  explicit Moments(std::int64_t started_ns) : started_ns_{started_ns}, history_{kKept_ns} {}

  void add(const SamplePtr& sample);
  /// @param ends  true: nothing more will come; what waits is given at once
  /// @return a moment that is complete; at most one at a call
  [[nodiscard]] std::optional<Moment> poll(std::int64_t now_ns, std::int64_t log_now_ns, bool ends = false);

  /// From now on, only what began before opens a moment: when a stack ends, each of its processes misses the
  /// others.
  void ignore_what_begins_after(std::int64_t log_time_ns) { ends_ns_ = log_time_ns; }

  [[nodiscard]] std::size_t bytes() const { return history_.bytes(); }
  [[nodiscard]] const observation::Traffic& traffic() const { return traffic_; }

 private:
  void open(const observation::Fault& fault);
  [[nodiscard]] Moment taken(std::int64_t log_now_ns);

  std::int64_t started_ns_, kept_until_ns_ = started_ns_;
  std::int64_t ends_ns_ = std::numeric_limits<std::int64_t>::max();
  History history_;
  observation::Traffic traffic_;
  FaultTimeline timeline_;
  std::optional<Moment> open_;      ///< without samples yet
  std::uint64_t newest_fault_ = 0;  ///< of the open moment
};

/// An order that ends a work as planned: disarm, idle time, homed. All other causes are stops.
[[nodiscard]] bool is_stop(const observation::Note& note);

}  // namespace crane::black_box
