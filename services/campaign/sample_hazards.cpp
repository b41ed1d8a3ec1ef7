/// Hazards 5 to 10, 47 and 48: processes that publish wrong samples, and foreign writers.
#include <cmath>
#include <limits>
#include <optional>

#include "campaign/hazards.hpp"
#include "campaign/traffic.hpp"

namespace crane::campaign {
namespace {

using topics::Description;

/// Topics between state and demand.
const std::array<const Description*, 4>& control_topics() {
  static const std::array<const Description*, 4> kTopics{
      &topics::reference.description, &topics::tracking.description, &topics::anti_swing.description,
      &topics::demand.description};
  return kTopics;
}

Injection lost(const Description& topic) {
  if (&topic == &topics::state.description) return lost_state();
  if (&topic == &topics::command.description) return lost_command();
  return lost_demand();
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

/// Swaps the samples of each pair: every second sample is late; at most two consecutive ticks are incomplete.
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

/// Delivers one old sample instead of every later one.
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
  // The gate limits only every second reversal. A limited tick adds 4 to the count and the next tick
  // subtracts 1; the limit of 48 is reached after 32 ticks. The command acts one tick later.
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
  // If a controller loses every fifth sample, the load may swing. A stop at the swing limit is then correct.
  if (seldom)
    return {.expectation = {.reasons = {because(crane_CAUSE_SWING_LIMIT)}, .detection_ms = 20},
            .watched_s = 0.6,
            .visible = swings_too_far(bench)};
  auto injection = lost(topic);  // a flipped bit in the padding between fields leaves the sample intact
  injection.expectation.communication = false;
  injection.expectation.detection_ms = 300;
  return injection;
}

/// Expects that the readers of the topic detect a second writer.
Injection second_writer_of(const Description& topic) {
  const bool command = &topic == &topics::command.description;
  return {.expectation = {
              .reasons = {command ? latched(crane_LATCH_SECOND_WRITER) : because(crane_CAUSE_SECOND_WRITER)},
              .detection_ms = 20}};
}

/// A foreign writer with plausible samples and its own start-up number.
Injection intruder(Bench& bench, const Description& topic, crane_Source source, Random& random) {
  auto foreign_writer =
      std::make_shared<ForeignWriter>(bench, source, static_cast<std::uint32_t>(2 + random.pick(900)));
  bench.every_tick = [&bench, foreign_writer, &topic] { foreign_writer->publish_plausible(topic, bench); };
  return second_writer_of(topic);
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

void with_ledger(Setting& setting, Random& /*random*/) { setting.ledger = true; }

/// Forged samples with the source and epoch of the genuine writer, each before the genuine sample. The stack
/// has a ledger.
Injection forged_in_its_name(Bench& bench, Random& random) {
  static const std::array<const Description*, 3> kTopics{
      &topics::state.description, &topics::demand.description, &topics::command.description};
  const auto& topic = *kTopics[random.pick(kTopics.size())];
  bench.wire = on(topic, [&topic, axis = bench.axis()](const void* sample, const bus::Deliver& deliver) {
    StoredSample forged{topic};
    forged.keep(sample);
    forged.change_value(axis);
    forged.seal();
    deliver(forged.look());
    deliver(sample);
  });
  return second_writer_of(topic);
}

/// The clock of the bridge stands still, jumps, or runs at another rate.
Injection wrong_times(Bench& bench, Random& random) {
  static constexpr std::array kRates{0.0, 0.5, 1.9};
  const double rate = kRates[random.pick(kRates.size())];
  const auto jump_ns = static_cast<std::int64_t>(random.pick(2) * random.pick(20'000'000'000));
  bench.publish_fault = falsify(
      topics::state, [rate, jump_ns, first = std::optional<std::int64_t>{}](msg::State& state) mutable {
        auto& time_ns = state.header.sample_time_ns;
        if (!first) first = time_ns;
        time_ns = *first + jump_ns + static_cast<std::int64_t>(rate * static_cast<double>(time_ns - *first));
      });
  // At half the rate, the time of the first state deviates by less than a period: the readers use this state,
  // whose speeds are doubled.
  return {.expectation = {.reasons = {because(crane_CAUSE_STATE_STALE), because(crane_CAUSE_FOLLOWING_ERROR),
                                      because(crane_CAUSE_OVERSPEED)},
                          .detection_ms = 60}};
}

constexpr std::array kSampleHazards{
    Hazard{.number = 5, .name = "samples stale, duplicate, out of order", .inject = stale},
    Hazard{.number = 6, .name = "values not finite, out of range", .inject = not_finite},
    Hazard{.number = 7, .name = "step or jerk of a voltage", .inject = jumping},
    Hazard{.number = 8, .name = "corrupted payload", .inject = corrupted},
    Hazard{.number = 9, .name = "second writer", .inject = second_writer},
    Hazard{.number = 10, .name = "unauthorised writer", .inject = unauthorised},
    Hazard{.number = 47, .name = "sample times of the bridge wrong", .inject = wrong_times},
    Hazard{.number = 48,
           .name = "samples forged under their writer's name, with a ledger",
           .every = 5,
           .prepare = with_ledger,
           .inject = forged_in_its_name},
};

}  // namespace

std::span<const Hazard> sample_hazards() { return kSampleHazards; }

}  // namespace crane::campaign
