/// Forged RTPS packets on every loop topic, with the GUID of the genuine writer, its source, its start-up
/// number and its next sequence numbers. Permitted: the crane stops. Forbidden: motion.
#include <gmock/gmock.h>

#include <limits>

#include "../system/stranger.hpp"
#include "discovery_attack.hpp"

namespace crane::hostile {
namespace {

/// Forges the next samples of one writer towards one process.
template <class T>
class CopiedWriter {
 public:
  CopiedWriter(Packet model, const topics::Topic<T>& topic)
      : topic_{topic}, packet_{std::move(model)}, found_{find(packet_.message, topic).value()} {
    constexpr std::uint64_t kAhead = 1'000'000;  // the reader skips the genuine samples before this number
    number_ = sequence_number_of(packet_.message, found_.data) + kAhead;
    auto skip = packet_;
    skip.message =
        heartbeat(prefix_of(packet_.message), entities_of(packet_.message, found_.data).writer, number_);
    mouth_.send(skip);
  }
  template <class Spoil>
  void send(std::uint64_t tick, std::int64_t time_ns, const Spoil& spoil) {
    auto sample = found_.sample;
    spoil(sample);
    sample.header.tick = tick;
    sample.header.sample_time_ns = time_ns;
    replace(packet_.message, found_.data, topic_, sample);
    set_sequence_number(packet_.message, found_.data, number_++);
    mouth_.send(packet_);
  }
  [[nodiscard]] std::uint64_t sent() const { return mouth_.sent(); }

 private:
  const topics::Topic<T>& topic_;
  Packet packet_;
  Found<T> found_;
  std::uint64_t number_ = 0;
  Mouth mouth_;
};

struct Route {
  const char* topic;
  const char* reader;  ///< process that receives the forged packets
};
std::ostream& operator<<(std::ostream& out, const Route& route) {
  return out << route.topic << " to " << route.reader;
}

class CopiedGuid : public DiscoveryAttack, public testing::WithParamInterface<Route> {
 protected:
  /// Forges `spoil`ed samples for every tick of the bridge, and with extreme ticks and times, for a second.
  void attack() {
    bus::Bus bus{runtime::bus_options(stack_->bus_options(), "stranger", crane_SOURCE_MONITOR, 9)};
    auto states = bus.subscriber(topics::state);
    system_test::with_forgery_of(GetParam().topic, [&](const auto& topic, auto spoil) {
      CopiedWriter forged{heard(GetParam().reader, topic), topic};
      stack_->forget();
      const auto end = std::chrono::steady_clock::now() + 1s;
      while (std::chrono::steady_clock::now() < end) {
        bus.wait(2ms);
        while (const auto state = states.take()) {
          const auto& now = state->header;
          for (const std::uint64_t ahead : {0, 1}) forged.send(now.tick + ahead, now.sample_time_ns, spoil);
          if (now.tick % 10 != 0) continue;
          using Times = std::numeric_limits<std::int64_t>;
          for (const auto time_ns : {Times::min(), std::int64_t{0}, Times::max()})
            for (const auto tick : {std::uint64_t{0}, now.tick, std::numeric_limits<std::uint64_t>::max()})
              forged.send(tick, time_ns, spoil);
        }
        stack_->listen(0ms);
      }
      stack_->listen(300ms);
      std::cout << forged.sent() << " packets; ";
    });
  }
};

TEST_P(CopiedGuid, MovesNothingOfALockedCrane) {
  attack();
  expect_nothing_moved();
}

TEST_P(CopiedGuid, StopsAnArmedCraneInsteadOfMovingIt) {
  stack_->session().arm();
  attack();
  expect_hold_or_stop();
  EXPECT_FALSE(is(crane_STATE_HOLD)) << "the packets have no effect: this test proves nothing";
}

INSTANTIATE_TEST_SUITE_P(
    OnEveryLoopTopic, CopiedGuid,
    testing::Values(Route{"command", "plant"}, Route{"state", "supervisor"}, Route{"reference", "tracking"},
                    Route{"tracking", "friction_compensation"}, Route{"anti_swing", "friction_compensation"},
                    Route{"demand", "supervisor"}, Route{"supervisor", "trajectory_planner"}),
    [](const auto& test) { return std::string{test.param.topic}; });

class DemandWithoutLedger : public CopiedGuid {};

/// The same packets to a stack without ledger steer the armed crane: they are an effective attack.
TEST_P(DemandWithoutLedger, MovesAnArmedCrane) {
  ASSERT_NO_FATAL_FAILURE(start("", false));
  stack_->session().arm();
  attack();
  const auto& states = stack_->observer().states();
  double farthest_m = 0;
  for (const auto& state : states)
    farthest_m = std::max(farthest_m, std::abs(state.trolley_position_m - states.front().trolley_position_m));
  std::cout << "trolley moved by " << farthest_m << " m\n";
  EXPECT_GT(farthest_m, kStill_m);
}

INSTANTIATE_TEST_SUITE_P(Of, DemandWithoutLedger, testing::Values(Route{"demand", "supervisor"}));

}  // namespace
}  // namespace crane::hostile
