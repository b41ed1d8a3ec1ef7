/// Hazards 1 to 13, 26 and 27: processes that end, hang or publish wrong samples; network faults.
#include <cmath>
#include <limits>

#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

using topics::Description;

constexpr std::array kControllers{crane_SOURCE_PLANNER, crane_SOURCE_TRACKING, crane_SOURCE_ANTI_SWING,
                                  crane_SOURCE_FRICTION};

/// Topics between state and demand.
const std::array<const Description*, 4>& control_topics() {
  static const std::array<const Description*, 4> kTopics{
      &topics::reference.description, &topics::tracking.description, &topics::anti_swing.description,
      &topics::demand.description};
  return kTopics;
}

Injection lost_demand(double watched_s = 1) {
  return {.expectation = {.reasons = {because(crane_CAUSE_DEMAND_STALE)},
                          .detection_ms = 50,
                          .communication = true},
          .watched_s = watched_s};
}
Injection lost_command() {
  return {.expectation = {
              .reasons = {latched(crane_LATCH_COMMAND_STALE)}, .detection_ms = 60, .communication = true}};
}
/// The supervisor counts missing states, the bridge counts missing commands; the phase decides which of them
/// detects the fault first.
Injection lost_state() {
  return {.expectation = {.reasons = {because(crane_CAUSE_STATE_STALE), latched(crane_LATCH_COMMAND_STALE)},
                          .detection_ms = 60,
                          .communication = true}};
}
Injection nothing() { return {.expectation = {}, .watched_s = 0.6}; }

Injection lost(const Description& topic) {
  if (&topic == &topics::state.description) return lost_state();
  if (&topic == &topics::command.description) return lost_command();
  return lost_demand();
}

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

/// The converters keep the last voltage. Only the rig can remove the power: its relay closes the brakes.
Injection bridge_gone(Bench& bench, Random& random) {
  if (random.pick(2) == 0)
    bench.stack().kill(crane_SOURCE_PLANT);
  else
    bench.stack().suspend(crane_SOURCE_PLANT, runtime::kNever);
  return {.expectation = {
              .reasons = {because(crane_CAUSE_STATE_STALE)}, .detection_ms = 70, .volts_by_rig = true}};
}

const Description& any_loop_topic(Random& random) {
  const auto i = random.pick(6);
  if (i < 4) return *control_topics()[i];
  return i == 4 ? topics::state.description : topics::command.description;
}

Injection duplicates(Bench& bench, const Description& topic) {
  bench.wire =
      on(topic, [](const void* sample, const bus::Deliver& deliver) { deliver(sample), deliver(sample); });
  return nothing();
}

/// Swaps pairs of samples: every second sample is late, and no three ticks in a row are incomplete.
Injection swapped(Bench& bench, const Description& topic) {
  auto stored = std::make_shared<StoredSample>(topic);
  bench.wire = on(topic, [stored](const void* sample, const bus::Deliver& deliver) {
    if (stored->full()) {
      deliver(sample);
      deliver(stored->take());
    } else {
      stored->keep(sample);
    }
  });
  return nothing();
}

/// Repeats one old sample.
Injection replayed(Bench& bench, const Description& topic) {
  auto stored = std::make_shared<StoredSample>(topic);
  bench.wire = on(topic, [stored](const void* sample, const bus::Deliver& deliver) {
    if (!stored->full()) stored->keep(sample);
    deliver(stored->look());
  });
  return lost(topic);
}

Injection stale(Bench& bench, Random& random) {
  switch (random.pick(4)) {
    case 0:
      return duplicates(bench, any_loop_topic(random));
    case 1:
      return swapped(bench, *control_topics()[1 + random.pick(3)]);
    case 2:
      return replayed(bench, topics::command.description);
    default:
      return replayed(bench, any_loop_topic(random));
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Injection falsified_demand(Bench& bench, Random& random) {
  static constexpr std::array kValues{kNan, HUGE_VAL, -HUGE_VAL, 1e300, -1e9, 201.0};
  const double value_v = kValues[random.pick(kValues.size())];
  bench.publish_fault = falsify(topics::demand, [axis = bench.axis(), value_v](msg::Demand& demand) {
    demand.total_v[axis] = value_v;
  });
  return {.expectation = {.reasons = {because(crane_CAUSE_DEMAND_INVALID)}, .detection_ms = 30}};
}

Injection falsified_command(Bench& bench, Random& random) {
  static constexpr std::array kValues{kNan, HUGE_VAL, 10.5, -1e6};
  const double value_v = kValues[random.pick(kValues.size())];
  bench.publish_fault = falsify(topics::command, [axis = bench.axis(), value_v](msg::Command& command) {
    command.drive_v[axis] = value_v;
  });
  const auto reason = std::isfinite(value_v) ? crane_LATCH_COMMAND_RANGE : crane_LATCH_COMMAND_NOT_FINITE;
  return {.expectation = {.reasons = {latched(reason)}, .detection_ms = 10}};
}

Injection falsified_state(Bench& bench, Random& random) {
  const bool swing = random.pick(2) == 0;
  bench.publish_fault = falsify(topics::state, [swing](msg::State& state) {
    (swing ? state.swing_radial_rad : state.trolley_position_m) = kNan;
  });
  return {.expectation = {.reasons = {because(crane_CAUSE_STATE_STALE), because(crane_CAUSE_DEMAND_INVALID)},
                          .detection_ms = 30}};
}

Injection not_finite(Bench& bench, Random& random) {
  switch (random.pick(3)) {
    case 0:
      return falsified_command(bench, random);
    case 1:
      return falsified_state(bench, random);
    default:
      return falsified_demand(bench, random);
  }
}

/// Exceeds the voltage rate limit in every tick.
Injection jumping(Bench& bench, Random& random) {
  const double high_v = 9.9;
  auto side = std::make_shared<double>(random.sign());
  if (random.pick(2) == 0) {
    bench.publish_fault =
        falsify(topics::command, [axis = bench.axis(), side, high_v](msg::Command& command) {
          command.drive_v[axis] = (*side = -*side) * high_v;
        });
    return {.expectation = {.reasons = {latched(crane_LATCH_COMMAND_RATE)}, .detection_ms = 30}};
  }
  bench.publish_fault = falsify(topics::demand, [axis = bench.axis(), side, high_v](msg::Demand& demand) {
    demand.total_v[axis] = (*side = -*side) * high_v;
  });
  // The gate limits every second reversal only. A limited tick counts 4 and the next one -1 towards a limit
  // of 48: 32 ticks, and one until the command acts.
  return {.expectation = {.reasons = {because(crane_CAUSE_DEMAND_RATE)}, .detection_ms = 330},
          .visible = [&bench] { return bench.now().status.state >= crane_STATE_HOLD; }};
}

/// Publishes samples of one topic under another topic of the same type.
Injection swapped_topics(Bench& bench) {
  auto stored = std::make_shared<StoredSample>(topics::anti_swing.description);
  bench.wire = [stored](const Description& topic, const void* sample, const bus::Deliver& deliver) {
    if (topic.name == topics::anti_swing.description.name) stored->keep(sample);
    if (topic.name != topics::tracking.description.name || !stored->full())
      deliver(sample);
    else
      deliver(stored->look());
  };
  return lost_demand();
}

/// Flips a random bit of every sample, or changes a value of every fifth sample.
Injection corrupted(Bench& bench, Random& random) {
  if (random.pick(6) == 0) return swapped_topics(bench);
  const auto& topic = any_loop_topic(random);
  auto bits = std::make_shared<Random>(random.pick(1U << 30U));
  const bool seldom = random.chance(0.3);
  auto count = std::make_shared<int>(0);
  bench.wire = on(topic, [&topic, bits, seldom, count, axis = bench.axis()](const void* sample,
                                                                            const bus::Deliver& deliver) {
    StoredSample copy{topic};
    copy.keep(sample);
    const auto bit = bits->pick(topic.descriptor->m_size * 8);
    if (!seldom) copy.flip(bit);
    if (seldom && ++*count % 5 == 0) copy.change_value(axis);
    deliver(copy.look());
  });
  // A controller that loses every fifth sample may let the load swing: a stop at the swing limit is then
  // correct.
  if (seldom)
    return {.expectation = {.reasons = {because(crane_CAUSE_SWING_LIMIT)}, .detection_ms = 20},
            .watched_s = 0.6,
            .visible = swings_too_far(bench)};
  auto injection = lost(topic);  // a bit in the padding between fields has no effect: some samples are intact
  injection.expectation.communication = false;
  injection.expectation.detection_ms = 300;
  return injection;
}

/// A foreign writer with plausible samples and its own start-up number.
Injection intruder(Bench& bench, const Description& topic, crane_Source source, Random& random) {
  auto foreign_writer =
      std::make_shared<ForeignWriter>(bench, source, static_cast<std::uint32_t>(2 + random.pick(900)));
  bench.every_tick = [&bench, foreign_writer, &topic] { foreign_writer->publish_plausible(topic, bench); };
  const bool command = &topic == &topics::command.description;
  return {.expectation = {
              .reasons = {command ? latched(crane_LATCH_SECOND_WRITER) : because(crane_CAUSE_SECOND_WRITER)},
              .detection_ms = 20}};
}

Injection second_writer(Bench& bench, Random& random) {
  const auto& topic = any_loop_topic(random);
  return intruder(bench, topic, right_source(topic), random);
}

Injection unauthorised(Bench& bench, Random& random) {
  static constexpr std::array kWrong{crane_SOURCE_NONE, crane_SOURCE_OPERATOR, crane_SOURCE_MONITOR,
                                     crane_SOURCE_TWIN};
  return intruder(bench, any_loop_topic(random), kWrong[random.pick(kWrong.size())], random);
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
    case 0:  // disconnects operator and observers
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
  return {.expectation = {.reasons = {because(crane_CAUSE_OVERRUN)}, .detection_ms = 40, .acts_late_ms = 10}};
}

constexpr std::array kProcessHazards{
    Hazard{.number = 1, .name = "controller killed", .inject = controller_killed},
    Hazard{.number = 2, .name = "controller hung", .inject = controller_hung},
    Hazard{.number = 3, .name = "supervisor killed or hung", .inject = supervisor_gone},
    Hazard{.number = 4, .name = "bridge killed or hung", .inject = bridge_gone},
    Hazard{.number = 5, .name = "stale, duplicate, out of order", .inject = stale},
    Hazard{.number = 6, .name = "not finite, out of range", .inject = not_finite},
    Hazard{.number = 7, .name = "step or jerk of a voltage", .inject = jumping},
    Hazard{.number = 8, .name = "corrupted payload", .inject = corrupted},
    Hazard{.number = 9, .name = "second writer", .inject = second_writer},
    Hazard{.number = 10, .name = "unauthorised writer", .inject = unauthorised},
    Hazard{.number = 11, .name = "flood of requests", .inject = flood},
    Hazard{.number = 12, .name = "20 % loss", .inject = loss},
    Hazard{.number = 13, .name = "partition", .inject = partition},
    Hazard{.number = 26,
           .name = "wall-clock jump",
           .test_bed = TestBed::process,
           .verified_by = "time is an argument of every component; processes read CLOCK_MONOTONIC only"},
    Hazard{.number = 27, .name = "CPU starvation", .inject = starved},
};

}  // namespace

std::span<const Hazard> process_hazards() { return kProcessHazards; }

}  // namespace crane::campaign
