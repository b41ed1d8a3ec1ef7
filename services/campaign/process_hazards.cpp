/// Hazards 1 to 4, 11 to 13, 26 and 27: processes that end or hang; network faults.
#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

using topics::Description;

constexpr std::array kControllers{crane_SOURCE_PLANNER, crane_SOURCE_TRACKING, crane_SOURCE_ANTI_SWING,
                                  crane_SOURCE_FRICTION};

Injection controller_killed(Bench& bench, Random& random) {
  bench.stack().kill(kControllers[random.pick(kControllers.size())]);
  return lost_demand();
}

Injection controller_hung(Bench& bench, Random& random) {
  bench.stack().suspend(kControllers[random.pick(kControllers.size())], runtime::kNever);
  return lost_demand();
}

Injection supervisor_gone(Bench& bench, Random& random) {
  if (random.pick(2) == 0)
    bench.stack().kill(crane_SOURCE_SUPERVISOR);
  else
    bench.stack().suspend(crane_SOURCE_SUPERVISOR, runtime::kNever);
  auto injection = lost_command();
  injection.expectation.supervisor_gone = true;
  return injection;
}

/// The converters keep the last voltage. Only the rig can stop the crane: its relay closes the brakes.
Injection bridge_gone(Bench& bench, Random& random) {
  if (random.pick(2) == 0)
    bench.stack().kill(crane_SOURCE_PLANT);
  else
    bench.stack().suspend(crane_SOURCE_PLANT, runtime::kNever);
  return {.expectation = {
              .reasons = {because(crane_CAUSE_STATE_STALE)}, .detection_ms = 70, .volts_by_rig = true}};
}

Injection flood(Bench& bench, Random& random) {
  auto foreign_writer = std::make_shared<ForeignWriter>(bench, crane_SOURCE_OPERATOR, 7);
  const std::size_t each_tick = 200 + random.pick(400);
  const bool later = random.pick(2) == 0;
  bench.every_tick = [&bench, foreign_writer, each_tick, later] {
    foreign_writer->flood_requests(bench, each_tick, later);
  };
  return nothing();
}

Injection loss(Bench& bench, Random& random) {
  auto chances = std::make_shared<Random>(random.pick(1U << 30U));
  bench.wire = [chances](const Description& topic, const void* sample, const bus::Deliver& deliver) {
    if (!topic.every_tick || !chances->chance(0.2)) deliver(sample);
  };
  auto injection = lost_state();
  injection.expectation.reasons.push_back(because(crane_CAUSE_DEMAND_STALE));
  injection.expectation.may_ride_through = true;
  injection.expectation.communication = false;
  injection.expectation.loses_commands = true;
  injection.expectation.detection_ms = 1e6;
  return injection;
}

Injection partition(Bench& bench, Random& random) {
  const auto cut = [&bench](auto is_cut) {
    bench.wire = [is_cut](const Description& topic, const void* sample, const bus::Deliver& deliver) {
      if (!is_cut(topic)) deliver(sample);
    };
  };
  switch (random.pick(3)) {
    case 0:  // disconnects operator and tools
      cut([](const Description& topic) { return !topic.every_tick; });
      return nothing();
    case 1:  // disconnects the computer of the controllers
      cut([](const Description& topic) { return &topic == &topics::demand.description; });
      return lost_demand();
    default:  // disconnects the computer of the rig
      cut([](const Description& topic) {
        return &topic == &topics::state.description || &topic == &topics::command.description;
      });
      return lost_state();
  }
}

Injection starved(Bench& bench, Random& random) {
  const auto late_ns = static_cast<std::int64_t>(random.between(5.2e6, 9.5e6));
  const bool once = random.pick(3) == 0;
  auto ticks = std::make_shared<int>(0);
  bench.every_tick = [&bench, late_ns, once, ticks] {
    if (once && ++*ticks > 1) return;
    bench.stack().suspend(crane_SOURCE_PLANT, bench.next_tick_ns() + late_ns);
  };
  if (once) return nothing();
  // The late bridge itself delays the stop by up to one tick.
  return {
      .expectation = {.reasons = {because(crane_CAUSE_OVERRUN)}, .detection_ms = 40, .bridge_delay_ms = 10}};
}

constexpr std::array kProcessHazards{
    Hazard{.number = 1, .name = "controller killed", .inject = controller_killed},
    Hazard{.number = 2, .name = "controller hung", .inject = controller_hung},
    Hazard{.number = 3, .name = "supervisor killed or hung", .inject = supervisor_gone},
    Hazard{.number = 4, .name = "bridge killed or hung", .inject = bridge_gone},
    Hazard{.number = 11, .name = "flood of requests", .inject = flood},
    Hazard{.number = 12, .name = "loss of 20 % of the samples", .inject = loss},
    Hazard{.number = 13, .name = "partition of the network", .inject = partition},
    Hazard{.number = 26,
           .name = "wall-clock jump",
           .test_bed = TestBed::process,
           .verified_by = "tests/system (ClockJump.*): processes read CLOCK_MONOTONIC only; the DDS "
                          "libraries read the wall clock"},
    Hazard{.number = 27, .name = "CPU starvation", .inject = starved},
};

}  // namespace

std::span<const Hazard> process_hazards() { return kProcessHazards; }

}  // namespace crane::campaign
