/// An attacker on another host. The stack runs without keys on an interface that other hosts reach. The
/// attacker knows what discovery and its own readers receive, and sends to all ports of the stack.
/// Permitted: the crane stops. Forbidden: motion.
#include <arpa/inet.h>
#include <gmock/gmock.h>

#include <functional>
#include <memory>

#include "../interop/two_hosts.hpp"
#include "../system/stranger.hpp"
#include "crane/bus/ports.hpp"
#include "discovery_attack.hpp"

namespace crane::hostile {
namespace {

using hosts::OnHost;
using hosts::TwoHosts;

class RemoteAttack : public DiscoveryAttack {
 protected:
  void SetUp() override {
    if (::geteuid() != 0) GTEST_SKIP() << "network namespaces need root";
    ASSERT_TRUE(hosts_.ok()) << "cannot make network namespaces with `ip netns`";
    near_.emplace(hosts_.near());
    start(reachable(default_options()));
  }
  void TearDown() override { stack_.reset(); }

  static stack::LaunchOptions reachable(stack::LaunchOptions options) {
    options.bus.interfaces = {TwoHosts::kNear};
    options.bus.insecure = true;
    return options;
  }
  /// Options of a program of the attacker. One process cannot use two interfaces with Cyclone DDS.
  [[nodiscard]] runtime::BusOptions remote() const {
    auto options = stack_->bus_options();
    options.interfaces = {TwoHosts::kFar};
    options.vendor = "fastdds";
    return options;
  }
  /// The ports of all processes of the loop, which discovery tells to every host. Multicast ports belong to
  /// the observer of this test, too, and the observer has no ledger.
  [[nodiscard]] std::vector<sockaddr_in> all_ports() {
    std::vector<sockaddr_in> all;
    for (const char* process : kLoop)
      for (const auto port : ports(process)) {
        if (bus::first_port(kDomain) <= port && port < bus::unicast_port(kDomain, 0)) continue;
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        ::inet_pton(AF_INET, TwoHosts::kNear, &to.sin_addr);
        all.push_back(to);
      }
    return all;
  }
  /// A packet with a sample of the genuine writer, as a reader of the attacker receives it.
  template <class T>
  Bytes overheard(bus::Bus& bus, const topics::Topic<T>& topic) {
    const auto reader = bus.subscriber(topic);
    Ear ear{hosts_.far_device().c_str()};
    const auto end = std::chrono::steady_clock::now() + 5s;
    while (std::chrono::steady_clock::now() < end)
      if (auto packet = ear.next(20ms); packet && find(packet->message, topic)) return packet->message;
    throw std::runtime_error("no such packet heard");
  }

  TwoHosts hosts_;
  std::optional<OnHost> near_;
};

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
