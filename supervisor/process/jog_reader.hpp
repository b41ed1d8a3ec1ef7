#pragma once
/// Reads crane/jog for the session of the stick, publishes the samples of the session on crane/accepted_jog,
/// and reports samples that have no effect.
#include "crane/runtime/component.hpp"
#include "crane/runtime/node.hpp"
#include "process/jog_session.hpp"

namespace crane::supervisor {

class JogReader {
 public:
  explicit JogReader(const runtime::Context& context)
      : samples_{context.ports.input(topics::jog)},
        accepted_{context.ports.output(topics::accepted_jog)},
        session_{context.rig.period_s},
        node_{context.node} {}

  /// Takes a bounded number of samples: a flood must not delay the step. Events report the first
  /// sample of a program without a session and the first unusable sample, once per session.
  /// @param step  header of the step that takes the samples
  void take(const msg::Header& step, double now_s);
  /// Call when a request that moves axes is accepted: ends the open session, and begins one for
  /// REQUEST_JOG.
  /// @param sender  participant that sent the request
  void accepted(const msg::Request& request, const bus::ParticipantId& sender, double now_s);
  /// Ends the session in HOLD when JogSession::active() is false, and in every state except HOLD
  /// and RUN.
  void end_with(State state, double now_s);

  [[nodiscard]] const JogSession& session() const { return session_; }

 private:
  bus::Subscriber<msg::Jog> samples_;
  runtime::Output<msg::AcceptedJog> accepted_;
  JogSession session_;
  runtime::Node& node_;
  bool stranger_reported_ = false, unusable_reported_ = false;
};

}  // namespace crane::supervisor
