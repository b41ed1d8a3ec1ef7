// A program that is suspended during a motion ends the motion.
#include <gmock/gmock.h>

#include "bench.hpp"
#include "crane/bring_up/jog.hpp"

namespace crane::bring_up::test {
namespace {

JogPlan long_jog() {
  return {.axis = 0, .drive_v = 3, .distance = 0.5, .duration_s = 2, .release = {true, true, true}};
}

/// Suspends the program once, in the tick `kMoving` of a jog.
struct Suspension {
  static constexpr int kMoving = 60;
  static constexpr std::int64_t kDuration_ns = 200'000'000;
  int ticks = 0;
  Bench* bench = nullptr;
  std::int64_t passed_ns = 0;

  void wait(std::int64_t duration_ns) {
    passed_ns += duration_ns;
    if (++ticks != kMoving) return;
    passed_ns += kDuration_ns;
    if (bench != nullptr) bench->pass(kDuration_ns);
  }
};

std::string why_a_jog_ended(Bench& bench) {
  try {
    (void)run(bench.session(), long_jog());
  } catch (const Ended& ended) {
    return ended.what();
  }
  return "the jog was completed";
}

TEST(Suspended, EndsTheJogWhenTheRelayHasOpened) {
  Suspension suspension;
  Bench bench{tower(), tower(), {}, {.wait = [&](std::int64_t t) { suspension.wait(t); }}};
  suspension.bench = &bench;
  EXPECT_THAT(why_a_jog_ended(bench), testing::HasSubstr("the watchdog relay has opened"));
  EXPECT_EQ(suspension.ticks, Suspension::kMoving) << "no tick follows the suspension";
  bench.expect_safe();
}

/// Without a contact of the relay, the clock shows the suspension.
TEST(Suspended, EndsTheJogByTheClock) {
  Suspension suspension;
  Bench bench{
      tower(),
      tower(),
      {},
      {.wait = [&](std::int64_t t) { suspension.wait(t); }, .now_ns = [&] { return suspension.passed_ns; }}};
  EXPECT_THAT(why_a_jog_ended(bench), testing::HasSubstr("this program was suspended"));
  EXPECT_EQ(suspension.ticks, Suspension::kMoving);
  bench.expect_safe();
}

}  // namespace
}  // namespace crane::bring_up::test
