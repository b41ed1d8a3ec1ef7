#include "crane/supervisor/explain.hpp"

#include <algorithm>
#include <array>

#include "crane/supervisor/rules.hpp"
#include "process/request_rules.hpp"
#include "process/samples.hpp"

namespace crane::supervisor {
namespace {

constexpr double kLongAgo_s = 0, kNow_s = 1e6;

Limits limits_in_force(const msg::SupervisorStatus& status) {
  Limits limits;
  for (std::size_t i = 0; i < kAxes; ++i) {
    auto& axis = limits.axis[i];
    axis.present = status.volt_limit_v[i] > 0;
    axis.low_limit = status.low_limit[i];
    axis.high_limit = status.high_limit[i];
  }
  return limits;
}

Envelope envelope_of(const Limits& limits, const Sample& sample) {
  Envelope envelope;
  for (std::size_t i = 0; i < kAxes; ++i) {
    if (!limits.axis[i].present || sample.position_unknown[i]) continue;
    const double x = sample.position[i];
    envelope.position = envelope.position || x < limits.axis[i].low_limit || x > limits.axis[i].high_limit;
    envelope.limit_switch = envelope.limit_switch || sample.limit_low[i] || sample.limit_high[i];
  }
  return envelope;
}

Inputs inputs_of(const Limits& limits, const msg::SupervisorStatus& status, const msg::State* state) {
  Inputs in{.now_s = kNow_s, .self_test = SelfTest::passed, .standstill = true};
  in.state_stale = status.state_stale || state == nullptr;
  in.demand_stale = status.demand_stale;
  in.second_writer = status.second_writer;
  in.configuration_differs = status.configuration_differs;
  if (status.demand_invalid) in.gate_cause = Cause::demand_invalid;
  if (state != nullptr) {
    const Sample sample = sample_of(*state);
    in.estop_pressed = sample.estop_pressed;
    in.envelope = envelope_of(limits, sample);
    in.brakes_open = true;
    for (std::size_t i = kAxes; i-- > 0;) {
      if (!limits.axis[i].present) continue;
      in.brakes_open = in.brakes_open && !sample.brake_closed[i];
      if (sample.position_unknown[i]) in.not_homed = true, in.unhomed_axis = i;
    }
  }
  in.envelope.swing = status.swing_exceeded;
  return in;
}

/// @return why the operating mode permits no move at all; empty when it permits some
std::string moves_forbidden_in(const msg::SupervisorStatus& status) {
  msg::Request move{};
  move.kind = crane_REQUEST_MOVE;
  return problem_in_mode(move, static_cast<Mode>(status.mode), {});
}

}  // namespace

std::vector<Explained> explain(const msg::SupervisorStatus& status, const msg::State* state) {
  static constexpr std::array kAsked{std::pair{Request::reset, "reset"}, std::pair{Request::arm, "arm"},
                                     std::pair{Request::move, "move"}, std::pair{Request::home, "home"}};
  const Limits limits = limits_in_force(status);
  std::vector<Explained> explained;
  for (const auto& [request, name] : kAsked) {
    Inputs in = inputs_of(limits, status, state);
    in.requests[static_cast<std::size_t>(request)] = true;
    Memory memory{.state = static_cast<State>(status.state),
                  .cause = static_cast<Cause>(status.cause),
                  .entered_s = kNow_s,
                  .clear_since_s = kLongAgo_s,
                  .fresh_since_s = kLongAgo_s,
                  .idle_since_s = kNow_s,
                  .self_test_passed = true,
                  .homing = std::ranges::any_of(status.homing, [](bool homing) { return homing; })};
    const auto answer = step(limits, in, memory).answers[static_cast<std::size_t>(request)];
    const auto forbidden = request == Request::move ? moves_forbidden_in(status) : std::string{};
    if (answer.accepted && !forbidden.empty())
      explained.push_back({name, false, forbidden});
    else
      explained.push_back({name, answer.accepted, answer.reason});
  }
  return explained;
}

}  // namespace crane::supervisor
