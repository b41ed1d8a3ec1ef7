#include "process/jog_session.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace crane::supervisor {
namespace {

bool in_range(const msg::Jog& sample) {
  return std::ranges::all_of(sample.deflection, [](double share) { return std::abs(share) <= 1; });
}

}  // namespace

void JogSession::begin(const msg::Request& request, const bus::ParticipantId& sender, double now_s) {
  open_ = true;
  request_ = request;
  sender_ = sender;
  writer_.reset();
  begun_s_ = deflected_s_ = now_s;
  release(now_s);
}

void JogSession::release(double now_s) {
  neutral_s_ = now_s;
  last_sample_s_.reset();
  engaged_ = faulty_ = false;
  deflection_ = {};
}

bool JogSession::of_session(const msg::Jog& sample, const JogWriter& from) const {
  return sender_ != bus::kUnknownParticipant && from.participant == sender_ &&
         (!writer_ || *writer_ == from.writer) && sample.request_id == request_.id &&
         sample.header.epoch == request_.header.epoch && std::string_view{sample.client} == request_.client;
}

/// A delayed or repeated sample does not contain the present deflection.
bool JogSession::late(const msg::Jog& sample, std::uint64_t tick) const {
  const auto oldest = static_cast<std::uint64_t>(std::lround(kSilence_s / period_s_));
  return sample.header.tick < tick && tick - sample.header.tick > oldest;
}

JogSession::Deflection JogSession::selected_of(const msg::Jog& sample) const {
  Deflection selected{};
  for (std::size_t i = 0; i < selected.size(); ++i)
    if (request_.selected[i]) selected[i] = sample.deflection[i];
  return selected;
}

JogSession::Verdict JogSession::take(const msg::Jog& sample, const JogWriter& from, std::uint64_t tick,
                                     double now_s) {
  if (!of_session(sample, from)) return Verdict::stranger;
  if (!open_) return writer_ ? Verdict::ended : Verdict::stranger;
  writer_ = from.writer;
  if (!sample.engaged) {
    release(now_s);
    return Verdict::released;
  }
  const auto deflection = selected_of(sample);
  if (!in_range(sample) || late(sample, tick))
    faulty_ = true;
  else if (deflection == Deflection{})
    release(now_s);
  else if (silent(now_s) || now_s - neutral_s_ > kLongest_s)
    faulty_ = true;
  last_sample_s_ = now_s;
  engaged_ = !faulty_ && sample.header.tick <= tick;
  deflection_ = engaged_ ? deflection : Deflection{};
  if (deflection_ != Deflection{}) deflected_s_ = now_s;
  return engaged_ ? Verdict::acts : Verdict::released;
}

std::array<double, 3> JogSession::deflection(double now_s) const {
  return open_ && acts(now_s) ? deflection_ : Deflection{};
}

bool JogSession::active(double now_s) const {
  if (!open_) return false;
  if (!writer_) return now_s - begun_s_ <= kFirst_s;
  return acts(now_s) && now_s - deflected_s_ <= kLongest_s;
}

}  // namespace crane::supervisor
