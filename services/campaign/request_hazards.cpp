/// Hazards 32 and 35 to 38: requests that must be refused, and stops by the operator.
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"
#include "stack/data_files.hpp"

namespace crane::campaign {
namespace {

Injection bad_target(Bench& bench, Random& random) {
  const std::size_t i = bench.axis();
  const auto& drive = bench.setting().configured.drives[i];
  stack::OperatorRequest wanted{.kind = crane_REQUEST_MOVE};
  wanted.selected[i] = true;
  wanted.target[i] = random.pick(2) == 0 ? drive.high_limit + random.between(-0.9 * drive.soft_margin, 5)
                                         : drive.low_limit - random.between(-0.9 * drive.soft_margin, 5);
  bench.request(wanted);
  return refusal();
}

/// A request with id 0 cannot be distinguished from other requests.
Injection id_is_zero(Bench& bench, Random& /*random*/) {
  bench.request_without_id();
  return refusal();
}

Injection reset_too_soon(Bench& bench, Random& random) {
  bench.rig().board().press_estop(true);
  bench.run(0.5);
  bench.rig().board().press_estop(false);
  bench.run(random.between(0.02, 0.9));
  bench.request(crane_REQUEST_RESET);
  return refusal();
}

Injection reset_while_pressed(Bench& bench, Random& random) {
  emergency_stop(bench);
  if (random.pick(2) == 0)
    bench.rig().board().press_estop(true);
  else
    bench.rig().change_inputs = [i = bench.axis()](bridge::Inputs& inputs) { inputs.limit_low[i] = true; };
  bench.run(kClear_s);
  bench.request(crane_REQUEST_RESET);
  return refusal();
}

/// The reset button is stuck: the request continues after the cause has ended.
Injection reset_held(Bench& bench, Random& /*random*/) {
  emergency_stop(bench);
  bench.rig().board().press_estop(true);
  bench.run(0.2);
  bench.rig().board().press_estop(false);
  for (int tick = 0; tick < 130; ++tick) bench.request(crane_REQUEST_RESET);
  return refusal();
}

Injection arm_without_demand(Bench& bench, Random& random) {
  emergency_stop(bench);
  bench.run(kClear_s);
  bench.stack().suspend(crane_SOURCE_FRICTION, bench.next_tick_ns() + 40'000'000);
  bench.request(crane_REQUEST_RESET);
  bench.run(random.between(0.1, 0.8));
  bench.request(crane_REQUEST_ARM);
  return refusal();
}

Injection reset_beside_a_foreign_writer(Bench& bench, Random& random) {
  emergency_stop(bench);
  bench.run(kClear_s);
  auto foreign_writer = std::make_shared<ForeignWriter>(bench, crane_SOURCE_FRICTION,
                                                        static_cast<std::uint32_t>(2 + random.pick(900)));
  bench.every_tick = [&bench, foreign_writer] {
    foreign_writer->publish_plausible(topics::demand.description, bench);
  };
  bench.run(0.1);
  bench.request(crane_REQUEST_RESET);
  return refusal();
}

/// A writer ends, and a program of another kind writes its topic. After arming, the demand of this program
/// would move the crane.
Injection reset_with_a_foreign_writer(Bench& bench, Random& random) {
  bench.stack().kill(crane_SOURCE_FRICTION);
  bench.run(0.5);
  auto foreign_writer = std::make_shared<ForeignWriter>(bench, crane_SOURCE_OPERATOR,
                                                        static_cast<std::uint32_t>(2 + random.pick(900)));
  bench.every_tick = [&bench, foreign_writer] {
    foreign_writer->publish_plausible(topics::demand.description, bench);
  };
  bench.run(kClear_s);
  bench.request(crane_REQUEST_RESET);
  return refusal();
}

Injection refused(Bench& bench, Random& random) {
  static constexpr std::array kRefusedRequests{bad_target,
                                               id_is_zero,
                                               reset_too_soon,
                                               reset_while_pressed,
                                               reset_held,
                                               arm_without_demand,
                                               reset_beside_a_foreign_writer,
                                               reset_with_a_foreign_writer};
  return kRefusedRequests[random.pick(kRefusedRequests.size())](bench, random);
}

Injection bridge_restarts(Bench& bench, Random& random) {
  const bool moves = std::abs(bench.now().truth.speed[bench.axis()]) > 0.05;
  const bool load_swings = bench.now().status.state == crane_STATE_HOLD && random.pick(2) == 0;
  if (load_swings) bench.rig().board().kick(0.3, 0);
  bench.stack().kill(crane_SOURCE_PLANT);
  bench.run(0.4);
  bench.restart_bridge();
  if (!load_swings && (random.pick(2) == 0 || !moves))
    return {.expectation = {.reasons = {because(crane_CAUSE_BRIDGE_RESTARTED)},
                            .detection_ms = 50,
                            .volts_by_rig = true}};
  bench.run(2.5);
  bench.request(crane_REQUEST_RESET);
  return refusal();
}

void soon_idle(Setting& setting, Random& /*random*/) { setting.configured.limits.idle_lock_s = 0.6; }

/// Detection time: idle time and one tick after the start of HOLD. For a crane that was idle before, HOLD
/// began before the onset.
Injection idle(Bench& bench, Random& /*random*/) {
  const bool holds = bench.now().status.state == crane_STATE_HOLD;
  return {.expectation = {.reasons = {because(crane_CAUSE_IDLE)},
                          .may_ride_through = !holds,
                          .detection_ms = 610},
          .visible = [&bench] { return bench.now().status.state == crane_STATE_HOLD; }};
}

Injection operator_stops(Bench& bench, Random& random) {
  static constexpr std::array kStops{std::pair{crane_REQUEST_STOP, crane_CAUSE_OPERATOR_STOP},
                                     std::pair{crane_REQUEST_DISARM, crane_CAUSE_OPERATOR_DISARM},
                                     std::pair{crane_REQUEST_ESTOP, crane_CAUSE_OPERATOR_ESTOP}};
  const auto [request, cause] = kStops[random.pick(kStops.size())];
  const bool stopping = bench.now().status.state == crane_STATE_STOP_C1;
  bench.every_tick = [&bench, request = request, sent = false]() mutable {
    if (!sent) bench.send(request);
    sent = true;
  };
  return {.expectation = {.reasons = {because(cause)},
                          .may_ride_through = stopping && request != crane_REQUEST_ESTOP,
                          .detection_ms = 10},
          .watched_s = 2};
}

/// Controllers that continue to move during a controlled stop.
Injection stop_ignored(Bench& bench, Random& random) {
  const double volts_v = random.between(2.2, 3);
  bench.publish_fault =
      falsify(topics::demand, [i = bench.axis(), volts_v, tick = 0](msg::Demand& demand) mutable {
        demand.total_v[i] = (++tick / 25) % 2 == 0 ? volts_v : -volts_v;
      });
  bench.request(crane_REQUEST_STOP);
  return {.expectation = {.reasons = {because(crane_CAUSE_STOP_TIMEOUT)},
                          .may_ride_through = true,
                          .detection_ms = 8100},
          .watched_s = 9};
}

constexpr std::array kRequestHazards{
    Hazard{.number = 32, .name = "request that must be refused", .inject = refused},
    Hazard{.number = 35, .name = "bridge restarts", .inject = bridge_restarts},
    Hazard{.number = 36, .name = "no request", .prepare = soon_idle, .inject = idle},
    Hazard{.number = 37, .name = "operator stops", .inject = operator_stops},
    Hazard{.number = 38, .name = "controllers ignore a stop", .every = 6, .inject = stop_ignored},
};

}  // namespace

std::span<const Hazard> request_hazards() { return kRequestHazards; }

}  // namespace crane::campaign
