#include "process/jog_session.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace crane::supervisor {

void JogSession::begin(const msg::Request& request, double now_s) {
  open_ = true;
  request_ = request;
  writer_.reset();
  begun_s_ = now_s;
  engaged_ = false;
  deflection_ = {};
}

bool JogSession::of_request(const msg::Jog& sample) const {
  return sample.request_id == request_.id && sample.header.epoch == request_.header.epoch &&
         std::string_view{sample.client} == request_.client;
}

/// A delayed or repeated sample tells nothing about the present deflection.
bool JogSession::usable(const msg::Jog& sample, std::uint64_t tick) const {
  const auto oldest = static_cast<std::uint64_t>(std::lround(kSilence_s / period_s_));
  const bool recent = sample.header.tick <= tick && tick - sample.header.tick <= oldest;
  return recent && std::ranges::all_of(sample.deflection, [](double share) { return std::abs(share) <= 1; });
}

JogSession::Verdict JogSession::take(const msg::Jog& sample, const bus::WriterId& writer, std::uint64_t tick,
                                     double now_s) {
  if (!of_request(sample) || (writer_ && *writer_ != writer)) return Verdict::stranger;
  if (!open_) return writer_ ? Verdict::ended : Verdict::stranger;
  writer_ = writer;
  engaged_ = sample.engaged && usable(sample, tick);
  deflection_ = {};
  if (!engaged_) return Verdict::released;
  heard_s_ = now_s;
  for (std::size_t i = 0; i < deflection_.size(); ++i)
    if (request_.selected[i]) deflection_[i] = sample.deflection[i];
  return Verdict::acts;
}

std::array<double, 3> JogSession::deflection(double now_s) const {
  const bool acts = open_ && engaged_ && now_s - heard_s_ <= kSilence_s;
  return acts ? deflection_ : std::array<double, 3>{};
}

bool JogSession::held(double now_s) const {
  if (!open_) return false;
  return writer_ ? engaged_ && now_s - heard_s_ <= kSilence_s : now_s - begun_s_ <= kFirst_s;
}

}  // namespace crane::supervisor
