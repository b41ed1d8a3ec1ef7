/// Rate of the ticks of a process, from two of its reports.
#include "observation/traffic.hpp"

#include <gtest/gtest.h>

#include "samples.hpp"

namespace crane::observation {
namespace {

SamplePtr report(std::uint64_t ticks, std::int64_t at_ns, std::uint32_t epoch = 1) {
  msg::NodeStatus status{};
  status.node = crane_SOURCE_TRACKING;
  status.ticks = ticks;
  status.header.epoch = epoch;
  return sample_of(topics::node, status, at_ns);
}

TEST(TickRate, IsThatBetweenTheLastTwoReports) {
  Traffic traffic;
  const auto rate_hz = [&] { return traffic.nodes().at(crane_SOURCE_TRACKING).tick_rate_hz; };
  traffic.add(*report(100, 10 * kSecond_ns));
  EXPECT_FALSE(rate_hz());
  traffic.add(*report(200, 11 * kSecond_ns));
  EXPECT_DOUBLE_EQ(rate_hz().value(), 100);
  traffic.add(*report(240, 11 * kSecond_ns + kSecond_ns / 10));
  EXPECT_DOUBLE_EQ(rate_hz().value(), 100) << "a report of a change of phase is too short an interval";
  traffic.add(*report(250, 13 * kSecond_ns));
  EXPECT_NEAR(rate_hz().value(), 10 / 1.9, 1e-9);
}

TEST(TickRate, OfARestartedProcessIsUnknownUntilItsSecondReport) {
  Traffic traffic;
  const auto rate_hz = [&] { return traffic.nodes().at(crane_SOURCE_TRACKING).tick_rate_hz; };
  traffic.add(*report(100, 10 * kSecond_ns));
  traffic.add(*report(200, 11 * kSecond_ns));
  traffic.add(*report(300, 12 * kSecond_ns, 2));
  EXPECT_FALSE(rate_hz());
  traffic.add(*report(350, 13 * kSecond_ns, 2));
  EXPECT_DOUBLE_EQ(rate_hz().value(), 50);
}

}  // namespace
}  // namespace crane::observation
