/// Forged RTPS packets on every loop topic, with the GUID of the genuine writer, its source, its start-up
/// number and its next sequence numbers. Permitted: the crane stops. Forbidden: motion.
#include <memory>

#include "../system/stranger.hpp"
#include "discovery_attack.hpp"

namespace crane::hostile {
namespace {

struct Route {
  const char* topic;
  const char* reader;  ///< process that receives the forged packets
  const char* vendor = "cyclone";
};
std::ostream& operator<<(std::ostream& out, const Route& route) {
  return out << route.topic << " to " << route.reader << " with " << route.vendor;
}

class CopiedGuid : public DiscoveryAttack, public testing::WithParamInterface<Route> {
 protected:
  static stack::LaunchOptions with_vendor(stack::LaunchOptions options) {
    options.bus.vendor = GetParam().vendor;
    return options;
  }
  void SetUp() override {
    if (!Ear::permitted()) GTEST_SKIP() << "listening on the loop-back interface needs CAP_NET_RAW";
    start(with_vendor(default_options()));
  }
  void attack() {
    bus::Bus bus{runtime::bus_options(stack_->bus_options(), "stranger", crane_SOURCE_MONITOR, 9)};
    system_test::with_forgery_of(GetParam().topic, [&](const auto& topic, auto spoil) {
      const auto copy = [&] {
        return std::make_unique<decltype(CopiedWriter{Packet{}, topic})>(heard(GetParam().reader, topic),
                                                                         topic);
      };
      forge(bus, copy, spoil);
    });
  }
};

TEST_P(CopiedGuid, MovesNothingOfALockedCrane) {
  attack();
  expect_nothing_moved(states());
}

TEST_P(CopiedGuid, StopsAnArmedCraneInsteadOfMovingIt) {
  stack_->session().arm();
  attack();
  expect_hold_or_stop();
  EXPECT_FALSE(is(crane_STATE_HOLD)) << "the packets have no effect: this test proves nothing";
}

std::string route_of(const testing::TestParamInfo<Route>& test) {
  return std::string{test.param.topic} + "_" + test.param.vendor;
}
INSTANTIATE_TEST_SUITE_P(OnEveryLoopTopic, CopiedGuid, testing::ValuesIn(routes_in_turn<Route>(true)),
                         route_of);
INSTANTIATE_TEST_SUITE_P(LongOnEveryLoopTopic, CopiedGuid, testing::ValuesIn(routes_in_turn<Route>(false)),
                         route_of);

class DemandWithoutLedger : public CopiedGuid {};

/// The same packets to a stack without ledger steer the armed crane: they are an effective attack.
TEST_P(DemandWithoutLedger, MovesAnArmedCrane) {
  ASSERT_NO_FATAL_FAILURE(start(with_vendor(without_ledger())));
  stack_->session().arm();
  attack();
  std::cout << "trolley moved by " << farthest_m(states()) << " m\n";
  EXPECT_GT(farthest_m(states()), kStill_m);
}

INSTANTIATE_TEST_SUITE_P(Of, DemandWithoutLedger,
                         testing::Values(Route{"demand", "supervisor", "cyclone"},
                                         Route{"demand", "supervisor", "fastdds"}),
                         [](const auto& test) { return std::string{test.param.vendor}; });

}  // namespace
}  // namespace crane::hostile
