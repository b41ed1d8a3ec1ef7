#pragma once
/// Requests of operators in one step of the supervisor. Takes the due requests. Refuses a request that its
/// contents, the operating mode or the position of the crane does not permit; the state machine answers all
/// other requests. Replies after the status of the step. Holds the operating mode and the last accepted
/// move, which only requests change.
#include <string>
#include <string_view>
#include <vector>

#include "crane/runtime/component.hpp"
#include "crane/runtime/request_inbox.hpp"
#include "crane/supervisor/supervisor.hpp"
#include "process/jog_reader.hpp"
#include "process/request_rules.hpp"

namespace crane::supervisor {

class OperatorRequests {
 public:
  /// @param limits outlives this object
  OperatorRequests(const runtime::Context& context, const Limits& limits);

  void receive() { inbox_.receive(); }
  /// Call once per tick with a sample: the inbox compares the ticks of requests with it. @param
  /// now_ns  local time of the sample
  void stepped(const msg::Header& header, std::int64_t now_ns) { inbox_.stepped(header, now_ns); }

  /// Takes the requests that are due at the tick of `input` and enters the permitted ones into `input`.
  /// If one request stops the crane, all other requests are refused: they were sent without knowledge of
  /// the stop.
  /// @param last  motion and state before the step
  void collect(TickInput& input, const TickMemory& last, std::int64_t now_ns);
  /// Takes the answers of the state machine. An accepted move becomes the last move; an accepted session of
  /// the stick begins in `jogs`.
  void take_answers(const TickOutput& output, JogReader& jogs, double now_s);
  /// Publishes the replies, and the accepted requests. Call after the status of the step is published, so
  /// that a client that receives the reply has already received this status.
  void reply(const msg::Header& header);
  /// True while the requests of this step contain one that stops the crane.
  [[nodiscard]] bool stop_requested() const;
  /// The crane stops: earlier requests are obsolete.
  void stopped(std::int64_t now_ns) { inbox_.stopped(now_ns); }

  [[nodiscard]] Mode mode() const { return mode_; }
  /// Last accepted move; number 0: none.
  [[nodiscard]] const msg::AcceptedMove& move() const { return move_; }
  /// Call once per step. @param reference  null: none arrived; the last one then remains valid
  void note_reference(const msg::Reference* reference);
  /// True from the acceptance of a move until its reference has ended, or for 0.2 s
  /// (kLongestStart_s) if the planner does not begin the move.
  [[nodiscard]] bool is_moving() const { return reference_moving_ || ticks_to_take_up_ > 0; }

 private:
  struct DueRequest {
    msg::Request request;
    bus::ParticipantId sender;
  };
  struct Answer {
    msg::Request request;
    bool accepted;
    std::string reason;
  };

  [[nodiscard]] std::string problem_of_due(const msg::Request& request, const PerAxis& position,
                                           OncePerTick& once) const;
  void change_mode(const msg::Request& request, State state);
  void refuse_all_but_stops(TickInput& input);
  void answer(const msg::Request& request, bool accepted, std::string_view reason);

  const Limits& limits_;
  runtime::Node& node_;
  runtime::RequestInbox inbox_;
  runtime::Output<msg::AcceptedRequest> accepted_;
  std::vector<DueRequest> due_;  ///< of this step, for the state machine
  std::vector<Answer> answers_;  ///< of this step, to be published
  Mode mode_ = Mode::semi_automatic;
  msg::AcceptedMove move_{};
  std::uint64_t ticks_to_take_up_ = 0;
  bool reference_moving_ = false;
};

}  // namespace crane::supervisor
