// Recorded runs are replayed bit for bit; every change of a sample or of a law is found.
#include "replay/replay.hpp"

#include <gtest/gtest.h>

#include "crane/bus/cdr.hpp"
#include "experiments/experiment_run.hpp"
#include "friction_compensation/friction_compensation.hpp"
#include "recorded_crane.hpp"
#include "stack/data_files.hpp"

namespace crane::replay_test {
namespace {

using recording::TemporaryDirectory;
using replay::Result;

Result replayed(const std::filesystem::path& file) { return replay::replay(file, replay::loop_components()); }

void expect_equal(const std::filesystem::path& file, std::uint64_t ticks) {
  const auto result = replayed(file);
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.equal_ticks, ticks);
  EXPECT_TRUE(result.problems.empty());
}

/// A run of a scenario with a controller and a variant of the rig.
struct Case {
  const char *scenario, *controller, *variant;
};

class Scenario : public testing::TestWithParam<Case> {};

TEST_P(Scenario, IsReplayedBitForBit) {
  const TemporaryDirectory directory;
  const auto run = experiments::run_experiment({.scenario = stack::find_scenario(GetParam().scenario),
                                                .rig = stack::find_rig("virginia_tech_tower"),
                                                .controller = GetParam().controller,
                                                .variant = GetParam().variant,
                                                .integrator = simulator::Method::fast,
                                                .directory = directory / "run",
                                                .in_process = true,
                                                .picture = false,
                                                .bus = {},
                                                .vendors = {}});
  const auto result = replayed(directory / "run" / "recording.mcap");
  EXPECT_FALSE(result.first) << replay::sentence(*result.first);
  EXPECT_EQ(result.equal_ticks, run.outcome.last_tick + 1);
  EXPECT_EQ(result.origin.at("scenario"), GetParam().scenario);
  EXPECT_EQ(result.origin.at("controller"), run.controller);
}

INSTANTIATE_TEST_SUITE_P(
    Runs, Scenario,
    testing::Values(Case{"maneuver_3", "gain_scheduling_partial", ""}, Case{"maneuver_3", "delayed_2", ""},
                    Case{"maneuver_1", "time_optimal", "observer"}, Case{"maneuver_2", "fuzzy_printed", ""},
                    Case{"disturbance_kick", "delayed_1", ""}, Case{"hoist_while_moving", "lqr", ""}),
    [](const auto& run) { return std::string{run.param.scenario} + "_" + run.param.controller; });

class Replay : public testing::Test {
 protected:
  TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "run.mcap";
};

/// Requests arrive between ticks, without a tick in advance.
TEST_F(Replay, EqualsAMoveAStopAndASecondMove) {
  RecordedCrane crane{file_, "virginia_tech_tower", "gain_scheduling_partial"};
  crane.arm();
  crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, true, false}, .target = {0.8, 1, 0}});
  crane.run(1);
  crane.ask(crane_REQUEST_STOP);
  crane.run_until(crane_STATE_LOCKED, 10);
  ASSERT_EQ(crane.cause(), "OPERATOR_STOP");
  crane.run(1.2);
  crane.ask(crane_REQUEST_RESET);
  crane.run(1.2);
  crane.ask(crane_REQUEST_ARM);
  crane.run_until(crane_STATE_HOLD, 3);
  crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, false, true}, .target = {0.5, 0, 0.9}});
  crane.run(3);
  crane.ask(crane_REQUEST_ESTOP);
  crane.run(1);
  expect_equal(file_, crane.finish());
}

TEST_F(Replay, EqualsAStick) {
  RecordedCrane crane{file_, "virginia_tech_tower", "shaped_zvd"};
  crane.arm();
  crane.ask({.kind = crane_REQUEST_JOG, .selected = {true, true, false}});
  crane.deflect({0.6, -0.3, 0}, 2);
  EXPECT_EQ(crane.status().jog_deflection[0], 0.6);
  crane.deflect({-0.2, 0, 0}, 1);
  crane.run(1.5);  // the stick is silent
  EXPECT_EQ(crane.status().jog_deflection[0], 0);
  expect_equal(file_, crane.finish());
}

TEST_F(Replay, EqualsHomingOfAnAxis) {
  RecordedCrane crane{file_, "homing_servo_to_go", ""};
  crane.run(2.4);
  crane.ask(crane_REQUEST_RESET);
  crane.run(0.1);
  crane.ask({.kind = crane_REQUEST_HOME, .selected = {true, false, false}});
  crane.run(0.5);
  ASSERT_EQ(crane.status().state, crane_STATE_RUN) << crane.cause();
  ASSERT_TRUE(crane.status().homing[0]);
  crane.run_until(crane_STATE_LOCKED, 120);
  ASSERT_EQ(crane.cause(), "HOMED");
  expect_equal(file_, crane.finish());
}

/// An armed crane that moves for a second.
class Changed : public Replay {
 protected:
  void SetUp() override {
    RecordedCrane crane{file_, "virginia_tech_tower", "gain_scheduling_partial"};
    crane.arm();
    crane.ask({.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {0.8, 0, 0}});
    crane.run(1);
    ticks_ = crane.finish();
    ASSERT_GT(ticks_, 300U);
  }
  /// Copies the recording; `change` acts on one topic in one tick.
  std::filesystem::path changed(const topics::Description& topic, std::uint32_t tick,
                                const std::function<bool(std::vector<std::uint8_t>&)>& change) {
    const auto copy = directory_ / "changed.mcap";
    copy_changed(file_, copy, [&](const recording::Message& message, std::vector<std::uint8_t>& data) {
      return message.channel->topic != topic.name || message.sequence != tick || change(data);
    });
    return copy;
  }
  std::uint64_t ticks_ = 0;
};

TEST_F(Changed, AFlippedBitOfADemandIsNamedWithTickAndField) {
  constexpr std::size_t kTotal_v = bus::kEncapsulation_bytes + 24 + 6 * 8;  // after header, control, friction
  const auto copy = changed(topics::demand.description, 311, [](std::vector<std::uint8_t>& data) {
    data.at(kTotal_v) ^= 1U;
    return true;
  });
  const auto result = replayed(copy);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.equal_ticks, 311U);
  EXPECT_EQ(result.first->tick, 311U);
  EXPECT_DOUBLE_EQ(result.first->time_s, 3.11);
  EXPECT_EQ(result.first->topic, "crane/demand");
  EXPECT_EQ(result.first->what.field, "total_v[0]");
  EXPECT_NE(result.first->what.recorded, result.first->what.replayed);
}

TEST_F(Changed, AFlippedBitOfAMeasurementIsNamedByItsChecksum) {
  const auto copy = changed(topics::state.description, 200, [](std::vector<std::uint8_t>& data) {
    data.at(data.size() / 2) ^= 4U;
    return true;
  });
  const auto result = replayed(copy);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->tick, 200U);
  EXPECT_EQ(result.first->topic, "crane/state");
  EXPECT_EQ(result.first->what.field, "crc32c");
}

TEST_F(Changed, AnOmittedSampleIsADifference) {
  const auto result =
      replayed(changed(topics::command.description, 150, [](std::vector<std::uint8_t>&) { return false; }));
  ASSERT_TRUE(result.first);
  EXPECT_EQ(replay::sentence(*result.first),
            "crane/command of tick 150 (1.5 s): recorded no sample, replayed a sample");
}

TEST_F(Changed, AnOmittedRequestIsADifference) {
  const auto copy = directory_ / "changed.mcap";
  copy_changed(file_, copy, [](const recording::Message& message, std::vector<std::uint8_t>&) {
    return message.channel->topic != topics::request.description.name;
  });
  const auto result = replayed(copy);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->topic, "crane/command");
  EXPECT_EQ(result.first->what.field, "watchdog_permission");
}

/// Tick of the first demand with friction volts of the trolley.
std::uint64_t first_friction_tick(const std::filesystem::path& file) {
  std::uint64_t tick = 0;
  recording::McapReader reader{file};
  reader.for_each({.topics = {"crane/demand"}}, [&](const recording::Message& message) {
    msg::Demand demand{};
    EXPECT_TRUE(bus::CdrCodec::of(*topics::demand.description.descriptor)
                    .decode(message.data.subspan(bus::kEncapsulation_bytes), false, &demand));
    tick = demand.header.tick;
    return demand.friction_v[0] == 0;
  });
  return tick;
}

/// The same component with a slightly different law: its friction is larger by the factor 1 + 1e-6.
runtime::ComponentSpec other_friction_law() {
  auto spec = services::friction_compensation_spec();
  spec.make = [](const runtime::Context& context) {
    static configuration::Rig rig;
    rig = context.rig;
    for (auto& friction : rig.design.friction) friction.factor *= 1 + 1e-6;
    const runtime::Context other{context.ports, context.node,        rig, context.controller, context.bus,
                                 context.clock, context.monotonic_ns};
    return services::friction_compensation_spec().make(other);
  };
  return spec;
}

TEST_F(Changed, AnotherVersionOfALawIsFoundAtTheFirstTickInWhichItActs) {
  auto components = replay::loop_components();
  for (auto& component : components)
    if (component.source == crane_SOURCE_FRICTION) component = other_friction_law();
  const auto result = replay::replay(file_, components);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->tick, first_friction_tick(file_));
  EXPECT_EQ(result.first->topic, "crane/demand");
  EXPECT_EQ(result.first->what.field, "friction_v[0]");
}

TEST_F(Changed, ATruncatedRecordingIsReplayedUpToItsEnd) {
  const auto copy = directory_ / "small_chunks.mcap";
  copy_changed(file_, copy, [](const recording::Message&, std::vector<std::uint8_t>&) { return true; });
  expect_equal(copy, ticks_);
  const auto bytes = recording::contents_of(copy);
  std::uint64_t partial = 0, last = 0;
  for (std::size_t percent = 2; percent < 100; percent += 2) {
    SCOPED_TRACE(percent);
    recording::put_contents(copy, bytes.substr(0, bytes.size() * percent / 100));
    try {
      const auto result = replayed(copy);
      EXPECT_FALSE(result.first) << replay::sentence(*result.first);
      EXPECT_FALSE(result.problems.empty());
      EXPECT_GE(result.equal_ticks, last);
      last = result.equal_ticks;
      if (last < ticks_) ++partial;
    } catch (const replay::Refusal& refusal) {
      EXPECT_EQ(last, 0U) << refusal.what();  // the recording contains no sample of the first tick
    }
  }
  EXPECT_GT(partial, 1U);
  EXPECT_EQ(last, ticks_);  // only the index is missing
}

}  // namespace
}  // namespace crane::replay_test
