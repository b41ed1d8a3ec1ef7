/// The anti-swing component selects the right law and passes it the samples of one tick.
#include "anti_swing/anti_swing.hpp"

#include <gtest/gtest.h>

#include "../runtime/component_bench.hpp"
#include "crane/runtime/convert.hpp"

namespace crane::services {
namespace {

using runtime::test::ComponentBench;
using runtime::test::reference_at;
using runtime::test::state_at;

class AntiSwingComponent : public testing::TestWithParam<std::string> {
 protected:
  ComponentBench bench_{anti_swing_spec(), runtime::test::tower(), GetParam()};
  bus::Subscriber<msg::Contribution> output_ = bench_.listen(topics::anti_swing);
};

TEST_P(AntiSwingComponent, PublishesTheOutputOfItsLawInEveryTick) {
  const auto law = bench_.controller().make_anti_swing(bench_.rig().design);
  for (std::uint64_t k = 1; k <= 40; ++k) {
    const auto state = state_at(k, 0.01 * static_cast<double>(k % 7));
    const auto reference = reference_at(k);
    bench_.publish(topics::state, crane_SOURCE_PLANT, state);
    bench_.publish(topics::reference, crane_SOURCE_PLANNER, reference);
    bench_.step();
    if (k == 1) law->reset(runtime::measurement(state));
    const auto expected = law->step(runtime::measurement(state), runtime::reference(reference));
    const auto sample = output_.take();
    ASSERT_TRUE(sample) << "tick " << k;
    EXPECT_EQ(runtime::values(sample->drive_v), expected.drive_v) << "tick " << k;
    EXPECT_EQ(sample->correction[0].position, expected.correction[0].position) << "tick " << k;
    EXPECT_EQ(sample->drive_v[control::kHoist], 0) << "tick " << k;
  }
}

/// During homing, swing feedback would move the axis faster than its reference.
TEST_P(AntiSwingComponent, HasNoEffectOnAnAxisWhosePositionIsUnknown) {
  for (std::uint64_t k = 1; k <= 40; ++k) {
    auto state = state_at(k, 0.01 * static_cast<double>(k % 7));
    state.position_known[control::kTrolley] = false;
    bench_.publish(topics::state, crane_SOURCE_PLANT, state);
    bench_.publish(topics::reference, crane_SOURCE_PLANNER, reference_at(k));
    bench_.step();
    const auto sample = output_.take();
    ASSERT_TRUE(sample) << "tick " << k;
    EXPECT_EQ(sample->drive_v[control::kTrolley], 0) << "tick " << k;
    EXPECT_EQ(sample->correction[control::kTrolley].position, 0) << "tick " << k;
    EXPECT_EQ(sample->correction[control::kTrolley].speed, 0) << "tick " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, AntiSwingComponent,
                         testing::Values("gain_scheduling_full", "anti_swing_pd", "delayed_1", "delayed_2",
                                         "fuzzy_printed"),
                         [](const auto& suite) { return suite.param; });

}  // namespace
}  // namespace crane::services
