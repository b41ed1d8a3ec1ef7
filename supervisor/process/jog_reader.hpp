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

  /// Takes a bounded number of samples: a flood must not delay the step. An event names the first sample of a
  /// stranger and the first unusable sample of each session.
  /// @param step  header of the step that takes the samples
  void take(const msg::Header& step, double now_s);
  /// A move has been accepted: a session begins, or ends because the move replaces it.
  /// @param sender  participant that sent the request
  void accepted(const msg::Request& request, const bus::ParticipantId& sender, double now_s);
  /// Ends the session when the stick is released and the reference at rest, or the crane stops.
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
