/// The friction compensation component adds the contributions of one tick and the friction.
#include "friction_compensation/friction_compensation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "../runtime/component_bench.hpp"
#include "crane/control/friction_compensation.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::services {
namespace {

using runtime::test::ComponentBench;
using runtime::test::state_at;

msg::Contribution contribution(double trolley_v, double slew_v) {
  msg::Contribution sample{};
  sample.header = runtime::test::tick(1);
  sample.drive_v[control::kTrolley] = trolley_v;
  sample.drive_v[control::kSlew] = slew_v;
  return sample;
}

class FrictionComponent : public testing::Test {
 protected:
  [[nodiscard]] msg::Demand demand(const msg::State& state, const msg::Contribution& tracking,
                                   const msg::Contribution& anti_swing) {
    bench_.publish(topics::state, crane_SOURCE_PLANT, state);
    bench_.publish(topics::tracking, crane_SOURCE_TRACKING, tracking);
    bench_.publish(topics::anti_swing, crane_SOURCE_ANTI_SWING, anti_swing);
    bench_.step();
    const auto sample = output_.take();
    if (!sample) throw std::runtime_error{"no demand"};
    return *sample;
  }
  ComponentBench bench_{friction_compensation_spec(), runtime::test::tower()};
  bus::Subscriber<msg::Demand> output_ = bench_.listen(topics::demand);
};

TEST_F(FrictionComponent, SumsTheContributionsAndAddsTheFrictionOfTheDirection) {
  auto state = state_at(1);
  state.trolley_speed_mps = 0.2;
  state.slew_speed_radps = -0.3;
  const auto sample = demand(state, contribution(1.5, -2), contribution(0.25, 0.5));
  const auto& friction = bench_.rig().design.friction;
  EXPECT_EQ(sample.control_v[0], 1.75);
  EXPECT_EQ(sample.control_v[1], -1.5);
  EXPECT_EQ(sample.friction_v[0], control::friction_compensation_v(friction[0], 1.75, 0.2));
  EXPECT_EQ(sample.friction_v[1], control::friction_compensation_v(friction[1], -1.5, -0.3));
  EXPECT_GT(sample.friction_v[0], 0);
  EXPECT_LT(sample.friction_v[1], 0);
  EXPECT_EQ(sample.total_v[0], sample.control_v[0] + sample.friction_v[0]);
}

TEST_F(FrictionComponent, PassesOnASecondWriterThatAnEarlierProcessDetected) {
  auto tracking = contribution(1, 1);
  tracking.second_writer = true;
  EXPECT_TRUE(demand(state_at(1), tracking, contribution(0, 0)).second_writer);
}

TEST_F(FrictionComponent, KeepsVoltsThatAreNotFiniteSoThatTheGateRejectsThem) {
  EXPECT_TRUE(std::isnan(demand(state_at(1), contribution(std::nan(""), 0), contribution(0, 0)).total_v[0]));
}

TEST(FrictionComponentAtOneKilohertz, ChangesItsDirectionWithinTheRateLimitOfTheGate) {
  auto rig = runtime::test::tower();
  rig.period_s = 0.001;
  const double largest_step_v = rig.drives[control::kTrolley].volt_rate_limit_vps * rig.period_s / 2;
  ComponentBench bench{friction_compensation_spec(), rig};
  auto demands = bench.listen(topics::demand);
  double last_v = 0, largest_v = 0;
  for (std::uint64_t tick = 1; tick <= 40; ++tick) {
    auto tracking = contribution(tick / 5 % 2 == 0 ? 0.5 : -0.5, 0);  // changes its sign every 5 ms
    tracking.header = runtime::test::tick(tick);
    auto none = contribution(0, 0);
    none.header = runtime::test::tick(tick);
    bench.publish(topics::state, crane_SOURCE_PLANT, state_at(tick));
    bench.publish(topics::tracking, crane_SOURCE_TRACKING, tracking);
    bench.publish(topics::anti_swing, crane_SOURCE_ANTI_SWING, none);
    bench.step();
    const auto sample = demands.take();
    ASSERT_TRUE(sample);
    EXPECT_LE(std::abs(sample->friction_v[0] - last_v), largest_step_v * (1 + 1e-12)) << tick;
    last_v = sample->friction_v[0];
    largest_v = std::max(largest_v, last_v);
  }
  EXPECT_NEAR(largest_v, bench.rig().design.friction[0].stiction_positive_v, 1e-9) << "within 5 ms";
}

configuration::Rig adapting_tower() {
  auto rig = runtime::test::tower();
  rig.design.adaptation.enabled = true;
  return rig;
}

TEST(FrictionComponentWithAdaptation, PublishesItsLevelsInEveryTick) {
  ComponentBench bench{friction_compensation_spec(), adapting_tower()};
  auto levels = bench.listen(topics::adaptation);
  for (std::uint64_t tick = 1; tick <= 3; ++tick) {
    auto state = state_at(tick);
    state.brake_closed[control::kSlew] = true;
    state.applied_command_tick = tick - 1;
    auto none = contribution(0, 0);
    none.header = runtime::test::tick(tick);
    bench.publish(topics::state, crane_SOURCE_PLANT, state);
    bench.publish(topics::tracking, crane_SOURCE_TRACKING, none);
    bench.publish(topics::anti_swing, crane_SOURCE_ANTI_SWING, none);
    bench.step();
    const auto sample = levels.take();
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->header.tick, tick);
    EXPECT_EQ(sample->axis[0].positive.used_coulomb_v, bench.rig().design.friction[0].coulomb_positive_v);
    EXPECT_EQ(sample->axis[1].phase, crane_ADAPTATION_FROZEN);
    EXPECT_EQ(sample->axis[1].freeze, tick > 2 ? crane_FREEZE_BRAKE : crane_FREEZE_GAP);
    EXPECT_FALSE(levels.take());
  }
}

TEST(FrictionComponentWithAdaptation, HasNoSuchTopicByDefault) {
  ComponentBench bench{friction_compensation_spec(), runtime::test::tower()};
  EXPECT_EQ(bench.listen(topics::adaptation).matched(), 0);
}

TEST(Adaptation, IsOffInEveryRigFile) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator{CRANE_RIGS}) {
    if (entry.path().extension() != ".toml") continue;
    ++files;
    EXPECT_FALSE(configuration::load_rig(entry.path()).design.adaptation.enabled) << entry.path();
  }
  EXPECT_GT(files, 5);
}

}  // namespace
}  // namespace crane::services
