#pragma once
/// Selects the samples that the black box keeps: around every stop, fault and trip, from 10 s before the
/// first cause to 5 s after the last note. Overlapping incidents are one incident. No I/O and no
/// clock; bounded memory.
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "observation/fault_timeline.hpp"

namespace crane::black_box {

using observation::FaultTimeline;
using observation::History;
using observation::SamplePtr;

struct Incident {
  std::int64_t from_ns = 0, until_ns = 0;  ///< log time
  observation::Note first;                 ///< first cause of the incident
  std::size_t faults = 0;                  ///< number of merged faults
  std::vector<SamplePtr> samples;          ///< of all topics, in the order of log time
};

class Incidents {
 public:
  static constexpr std::int64_t kBefore_ns = FaultTimeline::kBefore_ns, kAfter_ns = FaultTimeline::kAfter_ns;
  /// Longest duration of an incident: a crane that trips continuously causes one file per minute.
  static constexpr std::int64_t kLongest_ns = 60'000'000'000;
  static constexpr std::int64_t kKept_ns = kBefore_ns + kLongest_ns + kAfter_ns;

  /// @param started_ns  older samples, from the history of writers of crane/event, are discarded
  explicit Incidents(std::int64_t started_ns) : started_ns_{started_ns}, history_{kKept_ns} {}

  void add(const SamplePtr& sample);
  /// Adds a note that no sample contains, for example the end of `crane up`.
  void add(observation::Note note) { timeline_.add(std::move(note)); }
  /// @param ends  true: no more samples will come; an open incident is returned at once
  /// @return an incident that is complete; at most one per call
  [[nodiscard]] std::optional<Incident> poll(std::int64_t now_ns, std::int64_t log_now_ns, bool ends = false);

  /// Ignores causes after this time: when a stack ends, each process detects the loss of the others.
  void ignore_causes_after(std::int64_t log_time_ns) { ends_ns_ = log_time_ns; }

  [[nodiscard]] std::size_t bytes() const { return history_.bytes(); }
  [[nodiscard]] const observation::Traffic& traffic() const { return traffic_; }

 private:
  void open(const observation::Fault& fault);
  [[nodiscard]] Incident taken(std::int64_t log_now_ns);

  std::int64_t started_ns_, kept_until_ns_ = started_ns_;
  std::int64_t ends_ns_ = std::numeric_limits<std::int64_t>::max();
  History history_;
  observation::Traffic traffic_;
  FaultTimeline timeline_;
  std::optional<Incident> open_;    ///< incident whose samples are not yet complete
  std::uint64_t newest_fault_ = 0;  ///< newest fault of the open incident
};

/// True for faults and for the operator's stops. False for planned ends: disarm, idle time, homed.
[[nodiscard]] bool is_stop(const observation::Note& note);

}  // namespace crane::black_box
