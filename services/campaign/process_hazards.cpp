/// Hazards 1 to 13, 26 and 27: processes that die, hang or go mad, and a network that does anything.
#include <cmath>
#include <limits>

#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

using topics::Description;

constexpr std::array kControllers{crane_SOURCE_PLANNER, crane_SOURCE_TRACKING, crane_SOURCE_ANTI_SWING,
                                  crane_SOURCE_FRICTION};

/// Topics of the way from state to command that end in the demand, and who stops when they fail.
const std::array<const Description*, 4>& control_topics() {
  static const std::array<const Description*, 4> kTopics{
      &topics::reference.description, &topics::tracking.description, &topics::anti_swing.description,
      &topics::demand.description};
  return kTopics;
}

Strike lost_demand(double watched_s = 1) {
  return {.expectation = {.reasons = {because(crane_CAUSE_DEMAND_STALE)},
                          .detection_ms = 50,
                          .communication = true},
          .watched_s = watched_s};
}
Strike lost_command() {
  return {.expectation = {
              .reasons = {latched(crane_LATCH_COMMAND_STALE)}, .detection_ms = 60, .communication = true}};
}
/// The supervisor counts missing states, the bridge missing answers: who is first depends on the phase.
Strike lost_state() {
  return {.expectation = {.reasons = {because(crane_CAUSE_STATE_STALE), latched(crane_LATCH_COMMAND_STALE)},
                          .detection_ms = 60,
                          .communication = true}};
}
Strike nothing() { return {.expectation = {}, .watched_s = 0.6}; }

Strike lost(const Description& topic) {
  if (&topic == &topics::state.description) return lost_state();
  if (&topic == &topics::command.description) return lost_command();
  return lost_demand();
}

Strike controller_killed(Bench& bench, Dice& dice) {
  bench.stack().kill(kControllers[dice.pick(kControllers.size())]);
  return lost_demand();
}

Strike controller_hung(Bench& bench, Dice& dice) {
  bench.stack().suspend(kControllers[dice.pick(kControllers.size())], runtime::kNever);
  return lost_demand();
}

Strike supervisor_gone(Bench& bench, Dice& dice) {
  if (dice.pick(2) == 0)
    bench.stack().kill(crane_SOURCE_SUPERVISOR);
  else
    bench.stack().suspend(crane_SOURCE_SUPERVISOR, runtime::kNever);
  auto strike = lost_command();
  strike.expectation.supervisor_gone = true;
  return strike;
}

/// The converters keep the last voltage: only the rig can take it away, and the relay closes the brakes.
Strike bridge_gone(Bench& bench, Dice& dice) {
  if (dice.pick(2) == 0)
    bench.stack().kill(crane_SOURCE_PLANT);
  else
    bench.stack().suspend(crane_SOURCE_PLANT, runtime::kNever);
  return {.expectation = {
              .reasons = {because(crane_CAUSE_STATE_STALE)}, .detection_ms = 70, .volts_by_rig = true}};
}

const Description& any_loop_topic(Dice& dice) {
  const auto i = dice.pick(6);
  if (i < 4) return *control_topics()[i];
  return i == 4 ? topics::state.description : topics::command.description;
}

Strike duplicates(Bench& bench, const Description& topic) {
  bench.wire =
      on(topic, [](const void* sample, const bus::Deliver& deliver) { deliver(sample), deliver(sample); });
  return nothing();
}

/// Pairs arrive in the wrong order: every second sample is late, no three are missing in a row.
Strike swapped(Bench& bench, const Description& topic) {
  auto held = std::make_shared<Held>(topic);
  bench.wire = on(topic, [held](const void* sample, const bus::Deliver& deliver) {
    if (held->full()) {
      deliver(sample);
      deliver(held->take());
    } else {
      held->keep(sample);
    }
  });
  return nothing();
}

/// From now on the old sample comes again and again.
Strike replayed(Bench& bench, const Description& topic) {
  auto held = std::make_shared<Held>(topic);
  bench.wire = on(topic, [held](const void* sample, const bus::Deliver& deliver) {
    if (!held->full()) held->keep(sample);
    deliver(held->look());
  });
  return lost(topic);
}

Strike stale(Bench& bench, Dice& dice) {
  switch (dice.pick(4)) {
    case 0:
      return duplicates(bench, any_loop_topic(dice));
    case 1:
      return swapped(bench, *control_topics()[1 + dice.pick(3)]);
    case 2:
      return replayed(bench, topics::command.description);
    default:
      return replayed(bench, any_loop_topic(dice));
  }
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Strike mad_demand(Bench& bench, Dice& dice) {
  static constexpr std::array kValues{kNan, HUGE_VAL, -HUGE_VAL, 1e300, -1e9, 201.0};
  const double value_v = kValues[dice.pick(kValues.size())];
  bench.mad = madness(topics::demand, [axis = bench.axis(), value_v](msg::Demand& demand) {
    demand.total_v[axis] = value_v;
  });
  return {.expectation = {.reasons = {because(crane_CAUSE_DEMAND_INVALID)}, .detection_ms = 30}};
}

Strike mad_command(Bench& bench, Dice& dice) {
  static constexpr std::array kValues{kNan, HUGE_VAL, 10.5, -1e6};
  const double value_v = kValues[dice.pick(kValues.size())];
  bench.mad = madness(topics::command, [axis = bench.axis(), value_v](msg::Command& command) {
    command.drive_v[axis] = value_v;
  });
  const auto reason = std::isfinite(value_v) ? crane_LATCH_COMMAND_RANGE : crane_LATCH_COMMAND_NOT_FINITE;
  return {.expectation = {.reasons = {latched(reason)}, .detection_ms = 10}};
}

Strike mad_state(Bench& bench, Dice& dice) {
  const bool swing = dice.pick(2) == 0;
  bench.mad = madness(topics::state, [swing](msg::State& state) {
    (swing ? state.swing_radial_rad : state.trolley_position_m) = kNan;
  });
  return {.expectation = {.reasons = {because(crane_CAUSE_STATE_STALE), because(crane_CAUSE_DEMAND_INVALID)},
                          .detection_ms = 30}};
}

Strike not_finite(Bench& bench, Dice& dice) {
  switch (dice.pick(3)) {
    case 0:
      return mad_command(bench, dice);
    case 1:
      return mad_state(bench, dice);
    default:
      return mad_demand(bench, dice);
  }
}

/// More than a volt rate limit allows, tick after tick.
Strike jumping(Bench& bench, Dice& dice) {
  const double high_v = 9.9;
  auto side = std::make_shared<double>(dice.sign());
  if (dice.pick(2) == 0) {
    bench.mad = madness(topics::command, [axis = bench.axis(), side, high_v](msg::Command& command) {
      command.drive_v[axis] = (*side = -*side) * high_v;
    });
    return {.expectation = {.reasons = {latched(crane_LATCH_COMMAND_RATE)}, .detection_ms = 30}};
  }
  bench.mad = madness(topics::demand, [axis = bench.axis(), side, high_v](msg::Demand& demand) {
    demand.total_v[axis] = (*side = -*side) * high_v;
  });
  // A reversal that is clamped leaves less of the next: every second one is within the rate. Due: 12 ticks of
  // clamping in a row weigh 4 each; one that is clamped and one that is not weigh 3: 32 ticks, and one until
  // it acts.
  return {.expectation = {.reasons = {because(crane_CAUSE_DEMAND_RATE)}, .detection_ms = 330},
          .visible = [&bench] { return bench.now().status.state >= crane_STATE_HOLD; }};
}

/// Two topics of one type are swapped on the way.
Strike carried_over(Bench& bench) {
  auto held = std::make_shared<Held>(topics::anti_swing.description);
  bench.wire = [held](const Description& topic, const void* sample, const bus::Deliver& deliver) {
    if (topic.name == topics::anti_swing.description.name) held->keep(sample);
    if (topic.name != topics::tracking.description.name || !held->full())
      deliver(sample);
    else
      deliver(held->look());
  };
  return lost_demand();
}

/// One bit of every sample is wrong, somewhere.
Strike corrupted(Bench& bench, Dice& dice) {
  if (dice.pick(6) == 0) return carried_over(bench);
  const auto& topic = any_loop_topic(dice);
  auto bits = std::make_shared<Dice>(dice.pick(1U << 30U));
  const bool seldom = dice.chance(0.3);
  auto count = std::make_shared<int>(0);
  bench.wire = on(topic, [&topic, bits, seldom, count, axis = bench.axis()](const void* sample,
                                                                            const bus::Deliver& deliver) {
    Held copy{topic};
    copy.keep(sample);
    const auto bit = bits->pick(topic.descriptor->m_size * 8);
    if (!seldom) copy.flip(bit);
    if (seldom && ++*count % 5 == 0) copy.spoil_value(axis);
    deliver(copy.look());
  });
  // A controller that misses every fifth sample may swing the load: then the limit of the swing is right.
  if (seldom)
    return {.expectation = {.reasons = {because(crane_CAUSE_SWING_LIMIT)}, .detection_ms = 20},
            .watched_s = 0.6,
            .visible = swings_too_far(bench)};
  auto strike = lost(topic);  // a bit between two fields is no part of the sample: some arrive intact
  strike.expectation.communication = false;
  strike.expectation.detection_ms = 300;
  return strike;
}

/// Another program with the words and the start-up number of its own.
Strike intruder(Bench& bench, const Description& topic, crane_Source source, Dice& dice) {
  auto stranger = std::make_shared<Stranger>(bench, source, static_cast<std::uint32_t>(2 + dice.pick(900)));
  bench.every_tick = [&bench, stranger, &topic] { stranger->speak(topic, bench); };
  const bool command = &topic == &topics::command.description;
  return {.expectation = {
              .reasons = {command ? latched(crane_LATCH_SECOND_WRITER) : because(crane_CAUSE_SECOND_WRITER)},
              .detection_ms = 20}};
}

Strike second_writer(Bench& bench, Dice& dice) {
  const auto& topic = any_loop_topic(dice);
  return intruder(bench, topic, right_source(topic), dice);
}

Strike unauthorised(Bench& bench, Dice& dice) {
  static constexpr std::array kWrong{crane_SOURCE_NONE, crane_SOURCE_OPERATOR, crane_SOURCE_MONITOR,
                                     crane_SOURCE_TWIN};
  return intruder(bench, any_loop_topic(dice), kWrong[dice.pick(kWrong.size())], dice);
}

Strike flood(Bench& bench, Dice& dice) {
  auto stranger = std::make_shared<Stranger>(bench, crane_SOURCE_OPERATOR, 7);
  const std::size_t each_tick = 200 + dice.pick(400);
  const bool later = dice.pick(2) == 0;
  bench.every_tick = [&bench, stranger, each_tick, later] {
    stranger->flood_requests(bench, each_tick, later);
  };
  return nothing();
}

Strike loss(Bench& bench, Dice& dice) {
  auto chances = std::make_shared<Dice>(dice.pick(1U << 30U));
  bench.wire = [chances](const Description& topic, const void* sample, const bus::Deliver& deliver) {
    if (!topic.every_tick || !chances->chance(0.2)) deliver(sample);
  };
  auto strike = lost_state();
  strike.expectation.reasons.push_back(because(crane_CAUSE_DEMAND_STALE));
  strike.expectation.may_ride_through = true;
  strike.expectation.communication = false;
  strike.expectation.loses_commands = true;
  strike.expectation.detection_ms = 1e6;
  return strike;
}

Strike partition(Bench& bench, Dice& dice) {
  const auto cut = [&bench](auto is_cut) {
    bench.wire = [is_cut](const Description& topic, const void* sample, const bus::Deliver& deliver) {
      if (!is_cut(topic)) deliver(sample);
    };
  };
  switch (dice.pick(3)) {
    case 0:  // operator and observers
      cut([](const Description& topic) { return !topic.every_tick; });
      return nothing();
    case 1:  // the controllers' computer
      cut([](const Description& topic) { return &topic == &topics::demand.description; });
      return lost_demand();
    default:  // the rig's computer
      cut([](const Description& topic) {
        return &topic == &topics::state.description || &topic == &topics::command.description;
      });
      return lost_state();
  }
}

Strike starved(Bench& bench, Dice& dice) {
  const auto late_ns = static_cast<std::int64_t>(dice.between(5.2e6, 9.5e6));
  const bool once = dice.pick(3) == 0;
  auto ticks = std::make_shared<int>(0);
  bench.every_tick = [&bench, late_ns, once, ticks] {
    if (once && ++*ticks > 1) return;
    bench.stack().suspend(crane_SOURCE_PLANT, bench.next_tick_ns() + late_ns);
  };
  if (once) return nothing();
  // The bridge that gives the volts is late itself: up to a tick is added to what a stop may take.
  return {.expectation = {.reasons = {because(crane_CAUSE_OVERRUN)}, .detection_ms = 40, .acts_late_ms = 10}};
}

constexpr std::array kOfProcesses{
    Hazard{.number = 1, .name = "controller killed", .strike = controller_killed},
    Hazard{.number = 2, .name = "controller hung", .strike = controller_hung},
    Hazard{.number = 3, .name = "supervisor killed or hung", .strike = supervisor_gone},
    Hazard{.number = 4, .name = "bridge killed or hung", .strike = bridge_gone},
    Hazard{.number = 5, .name = "stale, duplicate, out of order", .strike = stale},
    Hazard{.number = 6, .name = "not finite, out of range", .strike = not_finite},
    Hazard{.number = 7, .name = "step or jerk of a voltage", .strike = jumping},
    Hazard{.number = 8, .name = "corrupted payload", .strike = corrupted},
    Hazard{.number = 9, .name = "second writer", .strike = second_writer},
    Hazard{.number = 10, .name = "unauthorised writer", .strike = unauthorised},
    Hazard{.number = 11, .name = "flood of requests", .strike = flood},
    Hazard{.number = 12, .name = "20 % loss", .strike = loss},
    Hazard{.number = 13, .name = "partition", .strike = partition},
    Hazard{.number = 26,
           .name = "wall-clock jump",
           .place = Place::process,
           .elsewhere = "time is an argument of every component; processes read CLOCK_MONOTONIC only"},
    Hazard{.number = 27, .name = "CPU starvation", .strike = starved},
};

}  // namespace

std::span<const Hazard> process_hazards() { return kOfProcesses; }

}  // namespace crane::campaign
