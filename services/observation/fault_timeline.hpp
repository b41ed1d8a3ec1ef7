#pragma once
/// Faults in the order of time: the first cause of each stop, and its consequences. No I/O; the time is
/// an argument.
///
/// A note is a new cause of the supervisor, a new latch of the bridge, a warning or an error on crane/event,
/// or the silence of a process. Notes less than kQuiet_ns apart belong to one fault; the earliest note is the
/// first cause of the fault. An event that announces a cause or a latch is merged with the note of this cause
/// or latch. A process that became silent before a stop precedes the stop, even if the silence is detected
/// later.
#include <deque>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "observation/history.hpp"
#include "observation/traffic.hpp"

namespace crane::observation {

struct Note {
  enum class Kind : std::uint8_t {
    order,    ///< a stop that an operator or the idle time requested, or the end of a homing
    warning,  ///< a warning, or the orderly end of a process
    fault     ///< any other cause, a latch, an error, or the silence of a process
  };
  std::int64_t at_ns = 0;  ///< ns since 1970
  std::uint64_t tick = 0;
  Kind kind = Kind::fault;
  std::string from;  ///< process
  std::string what;  ///< "SWING_LIMIT", "LATCH_speed", code of an event
  std::string explanation, remedy;
  std::string key{};       ///< equal for a cause or latch and the event that announces it
  bool event = false;      ///< true: from crane/event
  bool announced = false;  ///< true: this note combines an event with the cause or latch that it announces
  bool earlier = false;    ///< true: the first sample already had this cause or latch
};

/// True for a stop or emergency stop that an operator requested; false for disarm, idle time and homing.
[[nodiscard]] bool is_operator_stop(const Note& note);

struct Fault {
  std::uint64_t number = 0;     ///< 1, 2, ...
  std::vector<Note> notes;      ///< first cause, then consequences
  std::uint64_t left_out = 0;   ///< number of discarded consequences
  std::int64_t last_ns = 0;     ///< time of the last note
  std::int64_t cleared_ns = 0;  ///< time of the next READY, ARMING, HOLD or RUN; 0: not yet
  /// Samples of the topics that are written every tick, from 10 s before to 5 s after the first cause, by
  /// topic; empty until then, and for old faults.
  std::map<std::size_t, std::vector<SamplePtr>> surrounding_samples;
  bool samples_stored = false;
};

class FaultTimeline {
 public:
  static constexpr std::int64_t kQuiet_ns = 3'000'000'000;
  static constexpr std::int64_t kBefore_ns = 10'000'000'000, kAfter_ns = 5'000'000'000;
  static constexpr std::size_t kMostFaults = 100, kMostNotes = 40, kMostFaultsWithSamples = 8;

  void add(const Sample& sample);
  /// Adds a note that no sample contains.
  void add(Note note) { put(std::move(note)); }
  /// Detects silent processes, and stores the data around a fault when they are complete.
  /// @return true when a fault is new or has changed since the last call
  bool poll(std::int64_t now_ns, std::int64_t log_now_ns, const Traffic& traffic, const History& history);

  [[nodiscard]] const std::deque<Fault>& faults() const { return faults_; }
  [[nodiscard]] const Fault* find(std::uint64_t number) const;
  [[nodiscard]] nlohmann::ordered_json json() const;

 private:
  void put(Note note);
  /// @return true when `note` and a stored note report the same fact, one by a topic and one by an event
  static bool merge(Fault& fault, const Note& note);
  void add_status(const Sample& sample, const msg::SupervisorStatus& status);
  void add_state(const Sample& sample, const msg::State& state);
  void add_event(const Sample& sample, const msg::Event& event);
  void notice_silence(std::int64_t now_ns, const Traffic& traffic);
  void store_surrounding_samples(std::int64_t log_now_ns, const History& history);

  std::deque<Fault> faults_;
  std::optional<crane_Cause> cause_;        ///< of the last status; nothing: no status yet
  std::optional<crane_LatchReason> latch_;  ///< of the last state; nothing: no state yet
  std::map<std::uint32_t, bool> silent_;    ///< by node number
  std::uint64_t next_number_ = 1;
  bool changed_ = false;
};

}  // namespace crane::observation
