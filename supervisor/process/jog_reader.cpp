#include "process/jog_reader.hpp"

namespace crane::supervisor {

void JogReader::take(const msg::Header& step, double now_s) {
  constexpr int kMostPerTick = 64;
  bus::SampleInfo info;
  for (int taken = 0; taken < kMostPerTick; ++taken) {
    const auto sample = samples_.take(&info);
    if (!sample) return;
    if (!info.valid || !topics::may_write(topics::jog.description, sample->header.source)) continue;
    const auto verdict = session_.take(*sample, {info.participant, info.writer}, step.tick, now_s);
    if (verdict == JogSession::Verdict::acts || verdict == JogSession::Verdict::released) {
      msg::AcceptedJog accepted{};
      accepted.header = step;
      accepted.jog = *sample;
      accepted_.publish(accepted);
    }
    if (verdict == JogSession::Verdict::stranger && !stranger_reported_) {
      stranger_reported_ = true;
      node_.warning("jog_stranger",
                    "a program without a session sent a sample of crane/jog: the sample has no effect",
                    "request a session first (crane jog); one operator drives at a time");
    } else if (verdict == JogSession::Verdict::released && sample->engaged && !unusable_reported_) {
      unusable_reported_ = true;
      node_.warning(
          "jog_unusable",
          "a sample of crane/jog has no effect: it is late, its deflection is outside [-1, 1], the stick "
          "has been deflected for 60 s without a break, or the stick has not been released since such a "
          "fault",
          "release the stick; send the newest tick with each sample, and deflections from -1 to 1");
    }
  }
}

void JogReader::accepted(const msg::Request& request, const bus::ParticipantId& sender, double now_s) {
  session_.end();
  if (request.kind != crane_REQUEST_JOG) return;
  session_.begin(request, sender, now_s);
  stranger_reported_ = unusable_reported_ = false;
}

void JogReader::end_with(State state, double now_s) {
  const bool rests = state == State::hold && !session_.active(now_s);
  if (rests || (state != State::hold && state != State::run)) session_.end();
}

}  // namespace crane::supervisor
