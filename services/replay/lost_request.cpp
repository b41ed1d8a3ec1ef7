#include "replay/lost_request.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

namespace crane::replay {
namespace {

struct StopKind {
  crane_Cause cause;
  crane_RequestKind kind;
};
constexpr std::array<StopKind, 3> kStops{{{crane_CAUSE_OPERATOR_STOP, crane_REQUEST_STOP},
                                          {crane_CAUSE_OPERATOR_DISARM, crane_REQUEST_DISARM},
                                          {crane_CAUSE_OPERATOR_ESTOP, crane_REQUEST_ESTOP}}};

bool is_its_move(const msg::Reply& reply, const msg::SupervisorStatus& before,
                 const msg::SupervisorStatus& after) {
  return after.move.number != before.move.number && after.move.request_id == reply.request_id &&
         std::string_view{after.move.client} == reply.client;
}

crane_RequestKind kind_between(const msg::SupervisorStatus& before, const msg::SupervisorStatus& after) {
  const auto* const stop = std::ranges::find(kStops, after.cause, &StopKind::cause);
  if (stop != kStops.end() && before.cause != after.cause) return stop->kind;
  if (after.mode != before.mode) return crane_REQUEST_MODE;
  if (before.state == crane_STATE_READY && after.state == crane_STATE_ARMING)
    return std::ranges::any_of(after.homing, [](bool homing) { return homing; }) ? crane_REQUEST_HOME
                                                                                 : crane_REQUEST_ARM;
  if (before.state != crane_STATE_READY && after.state == crane_STATE_READY) return crane_REQUEST_RESET;
  return crane_REQUEST_NONE;
}

}  // namespace

std::optional<msg::Request> request_behind(const msg::Reply& reply, const msg::SupervisorStatus& before,
                                           const msg::SupervisorStatus& after) {
  msg::Request request{};
  request.header.source = crane_SOURCE_OPERATOR;
  request.header.epoch = 1;
  request.id = reply.request_id;
  std::ranges::copy(reply.client, request.client);
  if (is_its_move(reply, before, after)) {
    request.kind = after.move.kind;
    std::ranges::copy(after.move.selected, request.selected);
    std::ranges::copy(after.move.target, request.target);
    std::ranges::copy(after.move.sine, request.sine);
    request.duration_s = after.move.duration_s;
    return request;
  }
  request.kind = kind_between(before, after);
  if (request.kind == crane_REQUEST_NONE) return std::nullopt;
  if (request.kind == crane_REQUEST_MODE) request.mode = after.mode;
  if (request.kind == crane_REQUEST_HOME) std::ranges::copy(after.homing, request.selected);
  return request;
}

std::optional<msg::Jog> jog_behind(const msg::SupervisorStatus& status) {
  const bool deflected = std::ranges::any_of(status.jog_deflection, [](double share) { return share != 0; });
  if (!deflected || status.mode == crane_MODE_MAINTENANCE) return std::nullopt;
  msg::Jog jog{};
  jog.header.tick = status.header.tick;
  jog.header.sample_time_ns = status.header.sample_time_ns;
  jog.header.source = crane_SOURCE_OPERATOR;
  jog.header.epoch = 1;
  jog.request_id = status.move.request_id;
  std::ranges::copy(status.move.client, jog.client);
  jog.engaged = true;
  std::ranges::copy(status.jog_deflection, jog.deflection);
  return jog;
}

msg::Jog released(msg::Jog jog, const msg::SupervisorStatus& status) {
  jog.header.tick = status.header.tick;
  jog.header.sample_time_ns = status.header.sample_time_ns;
  jog.engaged = false;
  std::ranges::fill(jog.deflection, 0);
  return jog;
}

std::string in_words(const msg::Request& request) {
  constexpr std::array kNames{"none",    "reset", "arm",      "disarm", "move", "stop", "e-stop",
                              "advance", "kick",  "shutdown", "follow", "home", "jog",  "mode"};
  const auto kind = static_cast<std::size_t>(request.kind);
  return std::string{kind < kNames.size() ? kNames[kind] : "unknown"} + " of client '" + request.client + "'";
}

}  // namespace crane::replay
