#pragma once
/// A recording of the recorder: its samples are in the order of their arrival at the recorder. The samples of
/// the loop state their tick. crane/accepted_request and crane/accepted_jog state the tick in which the
/// supervisor executed a request, or took a sample of the stick.
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "crane/recording/mcap_reader.hpp"
#include "replay/recorded_tick.hpp"

namespace crane::replay {

class ArrivalOrder {
 public:
  /// Reads accepted requests, accepted samples of the stick and statuses of the processes. @throws
  /// recording::ReadError
  explicit ArrivalOrder(recording::McapReader& reader);

  /// Controller that the processes report on crane/node; empty: no process reports one.
  [[nodiscard]] const std::string& controller() const { return controller_; }
  /// Calls `visit` for each tick in the order of the ticks, until `visit` returns false. The last visited
  /// tick has RecordedTick::ends when a replay cannot go on.
  void for_each(std::int64_t period_ns, const std::function<bool(const RecordedTick&)>& visit);
  /// Ticks before the first recorded tick; the replay assumes that the crane rested in them as in this tick.
  [[nodiscard]] std::uint64_t assumed_ticks() const { return assumed_; }

 private:
  struct Accepted {
    std::int64_t sent_ns;  ///< clock of the supervisor
    msg::Request request;
  };
  struct Published {
    std::int64_t sent_ns;  ///< clock of the writer
    Cdr cdr;
  };
  struct Gathered {
    RecordedTick tick;
    std::vector<Published> more_commands, more_statuses;  ///< second and later samples of the tick
  };
  void note(const recording::Message& message);
  void gather(const recording::Message& message, const topics::Description& topic);
  void complete(Gathered& gathered);
  void describe(RecordedTick& tick);
  [[nodiscard]] const RecordedTick* after(std::uint64_t number) const;  ///< null: not recorded
  [[nodiscard]] std::optional<msg::SupervisorStatus> next_status() const;
  void add_steps_without_state(Gathered& gathered);
  /// Decides whether the stack began with the first complete tick, or ran before the recorder. If it ran
  /// before, visits the assumed ticks before the first recorded tick.
  bool begin(RecordedTick& first, const std::function<bool(const RecordedTick&)>& visit);
  struct Between {
    std::int64_t after_ns, until_ns;
  };
  /// Adds the requests that the supervisor executed in the step between two statuses.
  /// @param times  time of the previous status (excluded) and of the status of the step
  void add_requests(std::uint64_t tick, const Between& times, std::vector<Received>& inputs);
  void add_jogs(RecordedTick& tick) const;

  recording::McapReader& reader_;
  std::int64_t period_ns_ = 0;
  std::string controller_;
  std::map<std::uint64_t, std::vector<Accepted>> accepted_;  ///< by tick
  std::map<std::uint64_t, std::vector<msg::Jog>> jogs_;      ///< by tick
  std::map<std::uint64_t, Gathered> ticks_;                  ///< not visited yet
  std::map<std::string_view, std::uint32_t> epochs_;         ///< of the writers, by topic
  std::optional<msg::SupervisorStatus> before_;  ///< status of the previous step of the supervisor
  std::optional<std::uint64_t> missing_demand_;  ///< missing_demand_count of `before_`; nothing: unknown
  std::uint64_t assumed_ = 0;
  std::optional<std::uint64_t> last_state_;  ///< last tick with a state
  bool has_earlier_ = false;  ///< true: there are states before the first step of the supervisor
};

}  // namespace crane::replay
