/// The tracking component selects the right law and passes it the samples of one tick.
#include "tracking/tracking.hpp"

#include <gtest/gtest.h>

#include "../runtime/component_bench.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::services {
namespace {

using runtime::test::ComponentBench;
using runtime::test::reference_at;
using runtime::test::state_at;

control::Volts law_volts(const ComponentBench& bench, const msg::State& state,
                         const control::Reference& wanted) {
  const auto law = bench.controller().make_tracking(bench.rig().design);
  law->reset(runtime::measurement(state));
  return law->step(runtime::measurement(state), wanted).drive_v;
}

TEST(TrackingComponent, PublishesTheVoltsOfItsLawForTheSameTick) {
  ComponentBench bench{tracking_spec(), runtime::test::tower(), "anti_swing_pd"};
  auto output = bench.listen(topics::tracking);
  const auto state = state_at(7, 0.05);
  const auto reference = reference_at(7, 0.1);
  bench.publish(topics::state, crane_SOURCE_PLANT, state);
  bench.publish(topics::reference, crane_SOURCE_PLANNER, reference);
  bench.step();
  const auto sample = output.take();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->header.tick, 7u);
  EXPECT_EQ(runtime::values(sample->drive_v), law_volts(bench, state, runtime::reference(reference)));
  EXPECT_NE(sample->drive_v[control::kTrolley], 0);
}

TEST(TrackingComponent, WaitsForTheReferenceOfItsTick) {
  ComponentBench bench{tracking_spec(), runtime::test::tower()};
  auto output = bench.listen(topics::tracking);
  bench.publish(topics::state, crane_SOURCE_PLANT, state_at(1));
  bench.publish(topics::reference, crane_SOURCE_PLANNER, reference_at(2));
  bench.step();
  EXPECT_FALSE(output.take());
  bench.publish(topics::reference, crane_SOURCE_PLANNER, reference_at(1));
  bench.step();
  ASSERT_TRUE(output.take());
}

TEST(TrackingComponent, AddsTheCorrectionOfTheAntiSwingLawToTheReference) {
  ComponentBench bench{tracking_spec(), runtime::test::tower(), "delayed_2"};
  auto output = bench.listen(topics::tracking);
  const auto state = state_at(1);
  msg::Contribution anti_swing{};
  anti_swing.header = runtime::test::tick(1);
  anti_swing.correction[control::kTrolley] = {.position = 0.02, .speed = 0.1, .acceleration = 0.3};
  bench.publish(topics::state, crane_SOURCE_PLANT, state);
  bench.publish(topics::reference, crane_SOURCE_PLANNER, reference_at(1));
  bench.publish(topics::anti_swing, crane_SOURCE_ANTI_SWING, anti_swing);
  bench.step();
  const auto sample = output.take();
  ASSERT_TRUE(sample);
  auto wanted = runtime::reference(reference_at(1, 0.02));
  wanted[control::kTrolley].speed = 0.1;
  wanted[control::kTrolley].acceleration = 0.3;
  EXPECT_EQ(runtime::values(sample->drive_v), law_volts(bench, state, wanted));
}

}  // namespace
}  // namespace crane::services
