/// Hazards 32 and 35 to 38: what an operator may ask for and must not get.
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"
#include "stack/data_files.hpp"

namespace crane::campaign {
namespace {

Strike bad_target(Bench& bench, Dice& dice) {
  const std::size_t i = bench.axis();
  const auto& drive = bench.setting().told.drives[i];
  stack::Wish wish{.kind = crane_REQUEST_MOVE};
  wish.selected[i] = true;
  wish.target[i] = dice.pick(2) == 0 ? drive.high_limit + dice.between(-0.9 * drive.soft_margin, 5)
                                     : drive.low_limit - dice.between(-0.9 * drive.soft_margin, 5);
  bench.ask(wish);
  return refusal();
}

/// A request without a number cannot be told from another.
Strike no_number(Bench& bench, Dice& /*dice*/) {
  bench.ask_without_number();
  return refusal();
}

Strike reset_too_soon(Bench& bench, Dice& dice) {
  bench.world().board().press_estop(true);
  bench.run(0.5);
  bench.world().board().press_estop(false);
  bench.run(dice.between(0.02, 0.9));
  bench.ask(crane_REQUEST_RESET);
  return refusal();
}

Strike reset_while_pressed(Bench& bench, Dice& dice) {
  stop_at_once(bench);
  if (dice.pick(2) == 0)
    bench.world().board().press_estop(true);
  else
    bench.world().spoil_inputs = [i = bench.axis()](bridge::Inputs& inputs) { inputs.limit_low[i] = true; };
  bench.run(kClear_s);
  bench.ask(crane_REQUEST_RESET);
  return refusal();
}

/// The button of the reset is stuck: the cause goes, the reset is still there.
Strike reset_held(Bench& bench, Dice& /*dice*/) {
  stop_at_once(bench);
  bench.world().board().press_estop(true);
  bench.run(0.2);
  bench.world().board().press_estop(false);
  for (int tick = 0; tick < 130; ++tick) bench.ask(crane_REQUEST_RESET);
  return refusal();
}

Strike arm_without_demand(Bench& bench, Dice& dice) {
  stop_at_once(bench);
  bench.run(kClear_s);
  bench.stack().suspend(crane_SOURCE_FRICTION, bench.next_tick_ns() + 40'000'000);
  bench.ask(crane_REQUEST_RESET);
  bench.run(dice.between(0.1, 0.8));
  bench.ask(crane_REQUEST_ARM);
  return refusal();
}

Strike reset_beside_a_stranger(Bench& bench, Dice& dice) {
  stop_at_once(bench);
  bench.run(kClear_s);
  auto stranger = std::make_shared<Stranger>(bench, crane_SOURCE_FRICTION,
                                             static_cast<std::uint32_t>(2 + dice.pick(900)));
  bench.every_tick = [&bench, stranger] { stranger->speak(topics::demand.description, bench); };
  bench.run(0.1);
  bench.ask(crane_REQUEST_RESET);
  return refusal();
}

/// A writer dies, and a program of another kind takes its topic. Arming it would move the crane by a
/// stranger's demand.
Strike reset_with_a_stranger(Bench& bench, Dice& dice) {
  bench.stack().kill(crane_SOURCE_FRICTION);
  bench.run(0.5);
  auto stranger = std::make_shared<Stranger>(bench, crane_SOURCE_OPERATOR,
                                             static_cast<std::uint32_t>(2 + dice.pick(900)));
  bench.every_tick = [&bench, stranger] { stranger->speak(topics::demand.description, bench); };
  bench.run(kClear_s);
  bench.ask(crane_REQUEST_RESET);
  return refusal();
}

Strike refused(Bench& bench, Dice& dice) {
  static constexpr std::array kWays{
      bad_target, no_number,          reset_too_soon,          reset_while_pressed,
      reset_held, arm_without_demand, reset_beside_a_stranger, reset_with_a_stranger};
  return kWays[dice.pick(kWays.size())](bench, dice);
}

Strike bridge_restarts(Bench& bench, Dice& dice) {
  const bool moves = std::abs(bench.now().truth.speed[bench.axis()]) > 0.05;
  const bool load_swings = bench.now().status.state == crane_STATE_HOLD && dice.pick(2) == 0;
  if (load_swings) bench.world().board().kick(0.3, 0);
  bench.stack().kill(crane_SOURCE_PLANT);
  bench.run(0.4);
  bench.restart_bridge();
  if (!load_swings && (dice.pick(2) == 0 || !moves))
    return {.expectation = {.reasons = {because(crane_CAUSE_BRIDGE_RESTARTED)},
                            .detection_ms = 50,
                            .volts_by_rig = true}};
  bench.run(2.5);
  bench.ask(crane_REQUEST_RESET);
  return refusal();
}

void soon_idle(Setting& setting, Dice& /*dice*/) { setting.told.limits.idle_lock_s = 0.6; }

/// Due: the idle time and one tick, from HOLD on; the HOLD of a crane that was idle before began before the
/// onset.
Strike idle(Bench& bench, Dice& /*dice*/) {
  const bool holds = bench.now().status.state == crane_STATE_HOLD;
  return {.expectation = {.reasons = {because(crane_CAUSE_IDLE)},
                          .may_ride_through = !holds,
                          .detection_ms = 610},
          .visible = [&bench] { return bench.now().status.state == crane_STATE_HOLD; }};
}

Strike operator_stops(Bench& bench, Dice& dice) {
  static constexpr std::array kWays{std::pair{crane_REQUEST_STOP, crane_CAUSE_OPERATOR_STOP},
                                    std::pair{crane_REQUEST_DISARM, crane_CAUSE_OPERATOR_DISARM},
                                    std::pair{crane_REQUEST_ESTOP, crane_CAUSE_OPERATOR_ESTOP}};
  const auto [request, cause] = kWays[dice.pick(kWays.size())];
  const bool stopping = bench.now().status.state == crane_STATE_STOP_C1;
  bench.every_tick = [&bench, request = request, asked = false]() mutable {
    if (!asked) bench.send(request);
    asked = true;
  };
  return {.expectation = {.reasons = {because(cause)},
                          .may_ride_through = stopping && request != crane_REQUEST_ESTOP,
                          .detection_ms = 10},
          .watched_s = 2};
}

/// Controllers that go on moving while the crane is to stop.
Strike stop_ignored(Bench& bench, Dice& dice) {
  const double volts_v = dice.between(2.2, 3);
  bench.mad = madness(topics::demand, [i = bench.axis(), volts_v, tick = 0](msg::Demand& demand) mutable {
    demand.total_v[i] = (++tick / 25) % 2 == 0 ? volts_v : -volts_v;
  });
  bench.ask(crane_REQUEST_STOP);
  return {.expectation = {.reasons = {because(crane_CAUSE_STOP_TIMEOUT)},
                          .may_ride_through = true,
                          .detection_ms = 8100},
          .watched_s = 9};
}

constexpr std::array kOfRequests{
    Hazard{.number = 32, .name = "request that must be refused", .strike = refused},
    Hazard{.number = 35, .name = "bridge starts anew", .strike = bridge_restarts},
    Hazard{.number = 36, .name = "nobody asks for anything", .prepare = soon_idle, .strike = idle},
    Hazard{.number = 37, .name = "operator stops", .strike = operator_stops},
    Hazard{.number = 38, .name = "controllers ignore a stop", .every = 6, .strike = stop_ignored},
};

}  // namespace

std::span<const Hazard> request_hazards() { return kOfRequests; }

}  // namespace crane::campaign
