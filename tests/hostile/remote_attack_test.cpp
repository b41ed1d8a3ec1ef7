/// Forged samples and a false program from another host. Permitted: the crane stops. Forbidden: motion.
#include <gmock/gmock.h>

#include <functional>
#include <memory>

#include "../system/stranger.hpp"
#include "remote_attack.hpp"

namespace crane::hostile {
namespace {

class RemoteCopiedGuid : public RemoteAttack, public testing::WithParamInterface<const char*> {
 protected:
  void attack() {
    const auto targets = all_ports();
    const auto bus = [&] {
      const OnHost far{hosts_.far()};
      return std::make_unique<bus::Bus>(runtime::bus_options(remote(), "stranger", crane_SOURCE_MONITOR, 9));
    }();
    system_test::with_forgery_of(GetParam(), [&](const auto& topic, auto spoil) {
      const auto copy = [&] {
        const OnHost far{hosts_.far()};
        return std::make_unique<decltype(CopiedWriter{Bytes{}, targets, topic})>(overheard(*bus, topic),
                                                                                 targets, topic);
      };
      forge(*bus, copy, spoil);
    });
  }
};

TEST_P(RemoteCopiedGuid, MovesNothingOfALockedCrane) {
  attack();
  expect_nothing_moved(states());
}

TEST_P(RemoteCopiedGuid, StopsAnArmedCraneInsteadOfMovingIt) {
  stack_->session().arm();
  attack();
  expect_hold_or_stop();
  EXPECT_FALSE(is(crane_STATE_HOLD)) << "the packets have no effect: this test proves nothing";
}

INSTANTIATE_TEST_SUITE_P(OnEveryLoopTopic, RemoteCopiedGuid,
                         testing::Values("command", "state", "reference", "tracking", "anti_swing", "demand",
                                         "supervisor"),
                         [](const auto& test) { return std::string{test.param}; });

/// A program of the attacker that writes all loop topics at the same time.
class RemoteStranger : public RemoteAttack {
 protected:
  void attack() {
    constexpr int kOtherEpoch = 1;
    epoch_ = states().front().header.epoch;
    stack_->forget();
    std::vector<std::function<void()>> writers;
    {
      const OnHost far{hosts_.far()};
      for (const char* topic :
           {"command", "state", "reference", "tracking", "anti_swing", "demand", "supervisor"})
        system_test::with_forgery_of(topic, [&](const auto& on, auto spoil) {
          using Writer = decltype(system_test::Stranger{remote(), on, spoil, kOtherEpoch});
          writers.emplace_back(
              [writer = std::make_shared<Writer>(remote(), on, spoil, kOtherEpoch)] { writer->speak(); });
        });
    }
    (void)stack_->until(
        [&] {
          for (const auto& write : writers) write();
          return false;
        },
        1500ms);
  }
  /// States of the genuine plant.
  [[nodiscard]] States honest_states() const {
    auto states = this->states();
    std::erase_if(states, [this](const auto& state) { return state.header.epoch != epoch_; });
    return states;
  }

 private:
  std::uint32_t epoch_ = 0;
};

TEST_F(RemoteStranger, MovesNothingOfALockedCrane) {
  attack();
  expect_nothing_moved(honest_states());
}

TEST_F(RemoteStranger, StopsAnArmedCraneInsteadOfMovingIt) {
  stack_->session().arm();
  attack();
  const auto states = honest_states();
  ASSERT_GT(states.size(), 50U);
  EXPECT_LE(farthest_m(states), kStill_m);
  EXPECT_TRUE(stands(states.back()));
  std::cout << "trolley moved by " << farthest_m(states) << " m\n";
}

class RemoteDemandWithoutLedger : public RemoteCopiedGuid {};

/// The same packets to a stack without ledger steer the armed crane: they are an effective attack.
TEST_P(RemoteDemandWithoutLedger, MovesAnArmedCrane) {
  ASSERT_NO_FATAL_FAILURE(start(reachable(without_ledger())));
  stack_->session().arm();
  attack();
  std::cout << "trolley moved by " << farthest_m(states()) << " m\n";
  EXPECT_GT(farthest_m(states()), kStill_m);
}
INSTANTIATE_TEST_SUITE_P(Of, RemoteDemandWithoutLedger, testing::Values("demand"),
                         [](const auto& test) { return std::string{test.param}; });

}  // namespace
}  // namespace crane::hostile
