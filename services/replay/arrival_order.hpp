#pragma once
/// A recording of the recorder: its samples are in the order of their arrival at the recorder. The samples of
/// the loop state their tick. crane/accepted_request states the tick in which the supervisor executed a
/// request.
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
  /// Reads accepted requests, samples of the stick and statuses of the processes. @throws
  /// recording::ReadError
  explicit ArrivalOrder(recording::McapReader& reader);

  /// Controller that the processes report on crane/node; empty: no process reports one.
  [[nodiscard]] const std::string& controller() const { return controller_; }
  /// Calls `visit` for each tick in the order of the ticks, until `visit` returns false. The last visited
  /// tick has RecordedTick::ends when a replay cannot go on.
  void for_each(std::int64_t period_ns, const std::function<bool(const RecordedTick&)>& visit);
  /// Ticks before the first recorded one, in which the crane rested as in this one.
  [[nodiscard]] std::uint64_t assumed_ticks() const { return assumed_; }
  /// Samples of the stick that were derived from the statuses of the supervisor, one line for each session.
  [[nodiscard]] const std::vector<std::string>& derived() const { return derived_; }

 private:
  struct Jog {
    std::int64_t sent_ns;  ///< clock of the writer
    msg::Jog sample;
    Cdr cdr;
  };
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
  void add_steps_without_state(Gathered& gathered);
  /// Decides how the stack began: with the first complete tick, or before the recorder did. In the second
  /// case, visits the ticks before the first recorded one.
  bool begin(RecordedTick& first, const std::function<bool(const RecordedTick&)>& visit);
  struct Between {
    std::int64_t after_ns, until_ns;
  };
  /// Adds the requests that the supervisor executed in the step between two statuses.
  /// @param times  of the status before, excluded, and of the status of the step
  void add_requests(std::uint64_t tick, const Between& times, std::vector<Received>& inputs);
  void add_jogs(RecordedTick& tick, const msg::SupervisorStatus& status, std::int64_t decided_ns);
  /// Adds a sample of the stick before the first recorded one of its session, also if none is recorded.
  void add_lost_jog(RecordedTick& tick, const msg::SupervisorStatus& status);
  [[nodiscard]] std::vector<Jog>::const_iterator first_jog_of(std::uint64_t request_id) const;

  recording::McapReader& reader_;
  std::int64_t period_ns_ = 0;
  std::string controller_;
  std::map<std::uint64_t, std::vector<Accepted>> accepted_;  ///< by tick
  std::vector<Jog> jogs_;
  std::size_t next_jog_ = 0;
  std::uint64_t lost_jogs_of_ = 0;    ///< request of the last session with derived samples of the stick
  std::uint32_t session_epoch_ = 0;   ///< start-up number of the program of the last session
  std::optional<msg::Jog> lost_jog_;  ///< the last derived sample, if it deflects the stick
  std::map<std::uint64_t, Gathered> ticks_;           ///< not visited yet
  std::map<std::string_view, std::uint32_t> epochs_;  ///< of the writers, by topic
  std::optional<msg::SupervisorStatus> before_;       ///< status of the previous step of the supervisor
  std::optional<std::uint64_t> missing_demand_;       ///< its missing_demand_count; nothing: unknown
  std::vector<std::string> derived_;
  std::uint64_t assumed_ = 0;
  std::optional<std::uint64_t> last_state_;  ///< last tick with a state
  bool has_earlier_ = false;  ///< true: there are states before the first step of the supervisor
};

}  // namespace crane::replay
