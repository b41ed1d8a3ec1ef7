/// The wall clock of the computer jumps while the crane moves, as a time service or an operator sets it. The
/// processes read CLOCK_MONOTONIC only; the DDS libraries stamp samples with the wall clock.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "../recording/temporary_directory.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 55;

/// Wall clock of the processes that start while this object exists (jumping_clock.cpp).
class WallClock {
 public:
  WallClock() {
    set(0s);
    ::setenv("CRANE_CLOCK_FILE", file_.c_str(), 1);
    ::setenv("LD_PRELOAD", (stack::program_directory() / "libjumping_clock.so").c_str(), 1);
  }
  ~WallClock() { ::unsetenv("LD_PRELOAD"); }
  WallClock(const WallClock&) = delete;
  WallClock& operator=(const WallClock&) = delete;
  void set(std::chrono::seconds offset) const {
    std::ofstream out{file_, std::ios::binary | std::ios::in | std::ios::out};
    if (!out) out.open(file_, std::ios::binary);
    const auto ns = std::int64_t{std::chrono::nanoseconds{offset}.count()};
    out.write(reinterpret_cast<const char*>(&ns), sizeof ns);
  }

 private:
  recording::TemporaryDirectory directory_;
  std::filesystem::path file_ = directory_ / "offset";
};

/// The parameter is the DDS vendor of the loop.
class ClockJump : public testing::TestWithParam<const char*> {
 protected:
  ClockJump() { EXPECT_TRUE(std::filesystem::exists(stack::program_directory() / "libjumping_clock.so")); }
  WallClock clock_;
  RunningStack running_{kDomain, "virginia_tech_tower", stack::Plant::simulated, "", GetParam()};
};

TEST_P(ClockJump, OfAnHourInBothDirectionsDoesNotDisturbAMove) {
  running_.session().arm();
  for (const double target_m : {1.05, 0.6}) {
    running_.session().request(
        {.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {target_m, 0, 0}}, "move");
    running_.forget();
    for (const auto offset : {3600s, -3600s, 86400s, -86400s, 1s, 0s}) {
      clock_.set(offset);
      running_.listen(300ms);
    }
    EXPECT_NO_THROW(running_.session().wait_for(crane_STATE_HOLD, 10s));
    for (const auto& status : running_.observer().statuses())
      ASSERT_TRUE(status.state == crane_STATE_RUN || status.state == crane_STATE_HOLD)
          << experiments::in_words(status);
    EXPECT_NEAR(running_.session().state()->trolley_position_m, target_m, 0.02);
  }
}

TEST_P(ClockJump, DoesNotDelayAStop) {
  running_.session().arm();
  clock_.set(-3600s);
  running_.session().request({.kind = crane_REQUEST_ESTOP}, "estop");
  EXPECT_NO_THROW(running_.session().wait_for(crane_STATE_ESTOP, 1s));
}

INSTANTIATE_TEST_SUITE_P(Vendors, ClockJump, testing::Values("cyclone", "fastdds"),
                         [](const auto& vendor) { return std::string{vendor.param}; });

}  // namespace
}  // namespace crane::system_test
