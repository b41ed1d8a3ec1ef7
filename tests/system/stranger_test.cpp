/// A foreign program with the bus of this project writes topics that only a process of the stack may write,
/// with copied headers. No forbidden motion occurs, and supervisor or bridge report the reason.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "running_stack.hpp"
#include "stack/data_files.hpp"
#include "stranger.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 78;

struct Attack {
  const char* topic;
  const char* vendor;
  int epoch_ahead;  ///< added to the received start-up number
};
std::ostream& operator<<(std::ostream& out, const Attack& attack) {
  return out << attack.topic << " from " << attack.vendor << ", start-up number + " << attack.epoch_ahead;
}
std::string test_name(const testing::TestParamInfo<Attack>& test) {
  return std::string{test.param.topic} + "_" + test.param.vendor +
         (test.param.epoch_ahead > 0 ? "_younger" : "");
}

class StrangerTest : public testing::TestWithParam<Attack> {
 protected:
  void attack_for(std::chrono::milliseconds duration) {
    auto options = stack_.bus_options();
    options.vendor = GetParam().vendor;
    const std::string topic = GetParam().topic;
    const auto run = [&](const auto& on, auto spoil) {
      Stranger stranger{options, on, spoil, GetParam().epoch_ahead};
      stack_.forget();
      (void)stack_.until(
          [&] {
            stranger.speak();
            return false;
          },
          duration);
    };
    with_forgery_of(topic, run);
  }
  /// States of the real plant: those with the counts of its encoders.
  [[nodiscard]] std::vector<msg::State> honest_states() const {
    auto states = stack_.observer().states();
    if (std::string{GetParam().topic} == "state")
      std::erase_if(states, [this](const msg::State& state) {
        const double counted_m = static_cast<double>(state.counts[0]) * kTrolleyUnitPerCount;
        return std::abs(state.trolley_position_m - counted_m) > 0.1;
      });
    return states;
  }
  [[nodiscard]] bool stopped_for_a_second_writer() const {
    const auto& statuses = stack_.observer().statuses();
    const auto& states = stack_.observer().states();
    return std::any_of(statuses.begin(), statuses.end(),
                       [](const auto& status) { return status.cause == crane_CAUSE_SECOND_WRITER; }) ||
           std::any_of(states.begin(), states.end(),
                       [](const auto& state) { return state.latch_reason == crane_LATCH_SECOND_WRITER; });
  }
  const double kTrolleyUnitPerCount =
      1 /
      configuration::load_rig(stack::find_rig("virginia_tech_tower").string()).encoders[0].counts_per_unit;
  RunningStack stack_{kDomain, "virginia_tech_tower"};
};

TEST_P(StrangerTest, MovesNothingOfALockedCrane) {
  ASSERT_TRUE(stack_.until(
      [this] {
        const auto& statuses = stack_.observer().statuses();
        return !statuses.empty() && statuses.back().state == crane_STATE_LOCKED;
      },
      5s));
  attack_for(1500ms);
  const auto states = honest_states();
  ASSERT_GT(states.size(), 100U);
  for (const auto& state : states)
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_TRUE(state.applied_v[i] == 0 && state.brake_closed[i])
          << GetParam() << ", tick " << state.header.tick;
  EXPECT_EQ(states.front().trolley_position_m, states.back().trolley_position_m);
}

TEST_P(StrangerTest, StopsAnArmedCraneInsteadOfMovingIt) {
  stack_.session().arm();
  attack_for(1500ms);
  const auto states = honest_states();
  ASSERT_GT(states.size(), 100U);
  EXPECT_TRUE(stopped_for_a_second_writer()) << GetParam();
  EXPECT_NEAR(states.front().trolley_position_m, states.back().trolley_position_m, 0.01);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(states.back().brake_closed[i]) << GetParam();
    EXPECT_EQ(states.back().applied_v[i], 0) << GetParam();
  }
}

INSTANTIATE_TEST_SUITE_P(OnEveryLoopTopic, StrangerTest,
                         testing::Values(Attack{"command", "cyclone", 0}, Attack{"command", "fastdds", 1},
                                         Attack{"demand", "cyclone", 0}, Attack{"tracking", "fastdds", 0},
                                         Attack{"anti_swing", "cyclone", 1},
                                         Attack{"reference", "cyclone", 0}, Attack{"state", "cyclone", 0},
                                         Attack{"supervisor", "fastdds", 1}),
                         test_name);

}  // namespace
}  // namespace crane::system_test
