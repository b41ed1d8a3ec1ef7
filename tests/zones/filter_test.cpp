// The bound of the zone filter against the simulated crane, and the reactions of the supervisor.
#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "guarded_crane.hpp"

namespace crane::zones_test {
namespace {

using supervisor::Cause;
using supervisor::State;

control::Zone wall_at(double x_m) {
  return {.name = "wall", .position_x_m = x_m, .size_x_m = 0.1, .size_y_m = 10, .bottom_m = -10, .top_m = 10};
}

configuration::Rig rig_with(const std::string& name, std::vector<control::Zone> zones) {
  auto rig = deployed_rig(name);
  rig.clearance = {.load_radius_m = 0.05, .suspension_height_m = 0, .cable_error = 0.1, .wind_mps2 = 0};
  rig.zones = std::move(zones);
  return rig;
}

/// Holds the trolley at a speed.
PerAxis at_speed(const GuardedCrane& crane, double speed_mps) {
  const double friction_v = speed_mps > 0 ? 1.0 : speed_mps < 0 ? -1.3 : 0;
  return {friction_v + std::clamp(20 * (speed_mps - crane.speed(0)), -8.0, 8.0), 0, 0};
}

/// Drives until the supervisor stops the crane. @return largest position of the load along the jib until rest
double drive_until_stopped(GuardedCrane& crane, double speed_mps) {
  double farthest_m = 0;
  for (int i = 0; i < 2500; ++i) {
    crane.tick(crane.armed() ? at_speed(crane, speed_mps) : PerAxis{});
    farthest_m = std::max(farthest_m, on_cable(crane.truth(), 1, 0)[0]);
  }
  return farthest_m;
}

class EverySpeed : public testing::TestWithParam<double> {};

TEST_P(EverySpeed, IsStoppedBeforeTheWallEvenIfTheLoadSwings) {
  const auto rig = rig_with("virginia_tech_tower", {wall_at(1.25)});
  GuardedCrane crane{rig, rig};
  const double farthest_m = drive_until_stopped(crane, GetParam());
  EXPECT_EQ(crane.cause(), Cause::zone) << supervisor::name_of(crane.cause());
  EXPECT_EQ(crane.state(), State::locked);
  EXPECT_LT(farthest_m, 1.2 - 0.05);
  std::cout << GetParam() << " m/s: the load comes to " << 1.2 - 0.05 - farthest_m << " m before the wall\n";
}

INSTANTIATE_TEST_SUITE_P(Zones, EverySpeed, testing::Values(0.05, 0.2, 0.5, 0.8), [](const auto& speed) {
  return std::to_string(static_cast<int>(100 * speed.param)) + "_cmps";
});

TEST(ZoneStop, OfAFastCraneIsControlledFirst) {
  const auto rig = rig_with("virginia_tech_tower", {wall_at(1.4)});
  GuardedCrane crane{rig, rig};
  while (crane.cause() == Cause::none) crane.tick(at_speed(crane, 0.6));
  EXPECT_EQ(crane.cause(), Cause::zone);
  EXPECT_FALSE(crane.memory.machine.ramping);
  // During a controlled stop by the planner, no ramped stop is necessary before the crane has slowed down.
  double speed_mps = crane.speed(0);
  const double from_mps = speed_mps;
  while (speed_mps > 0.05 && !crane.memory.machine.ramping) {
    speed_mps -= crane.limits.reference_acceleration[0] * crane.limits.period_s;
    crane.tick(at_speed(crane, speed_mps));
  }
  std::cout << "from " << from_mps << " m/s, a ramped stop at " << crane.speed(0) << " m/s\n";
  EXPECT_LT(crane.speed(0), 0.4);
}

TEST(ZoneStop, StartsFromZeroVolts) {
  const auto rig = rig_with("virginia_tech_tower", {wall_at(1.25)});
  GuardedCrane crane{rig, rig};
  while (crane.cause() == Cause::none) crane.tick(at_speed(crane, 0.5));
  while (crane.state() == State::stop_c1 && !crane.memory.machine.ramping) crane.tick(at_speed(crane, 0.5));
  EXPECT_EQ(crane.cause(), Cause::zone);
  EXPECT_EQ(crane.out.drive_v, PerAxis{});
}

void rearm(GuardedCrane& crane) {
  for (int i = 0; i < 600; ++i) crane.tick({});
  for (const auto request : {supervisor::Request::reset, supervisor::Request::arm}) {
    crane.input.requests[static_cast<std::size_t>(request)] = true;
    crane.tick({});
    crane.input.requests = {};
    for (int i = 0; i < 20; ++i) crane.tick({});
  }
}

TEST(ZoneStop, LetsTheCraneLeaveTheZoneAfterwards) {
  const auto rig = rig_with("virginia_tech_tower", {wall_at(1.25)});
  GuardedCrane crane{rig, rig};
  drive_until_stopped(crane, 0.2);
  rearm(crane);
  ASSERT_TRUE(crane.armed()) << supervisor::name_of(crane.cause());
  const double from_m = crane.truth().trolley_m;
  for (int i = 0; i < 300; ++i) crane.tick(at_speed(crane, -0.1));
  EXPECT_TRUE(crane.armed()) << supervisor::name_of(crane.cause());
  EXPECT_LT(crane.truth().trolley_m, from_m - 0.2);
}

TEST(ZoneStop, LetsACraneThatHangsInsideTheMarginLeaveSlowlyButNotComeCloser) {
  auto rig = rig_with("virginia_tech_tower", {wall_at(0.37)});  // 0.02 m from the load, inside its radius
  for (const double speed_mps : {-0.05, 0.05}) {
    GuardedCrane crane{rig, rig};
    ASSERT_TRUE(crane.armed()) << supervisor::name_of(crane.cause());
    for (int i = 0; i < 200 && crane.armed(); ++i) crane.tick(at_speed(crane, speed_mps));
    EXPECT_EQ(crane.armed(), speed_mps < 0) << supervisor::name_of(crane.cause());
    if (speed_mps > 0) {
      EXPECT_EQ(crane.cause(), Cause::zone);
      EXPECT_LT(crane.truth().trolley_m, 0.315);
    }
  }
}

TEST(ZoneFilter, ChangesNoVoltageFarFromAZone) {
  std::mt19937_64 random{7};
  const auto without = rig_with("virginia_tech_tower", {}),
             with = rig_with("virginia_tech_tower", {wall_at(-20)});
  GuardedCrane one{without, without}, other{with, with};
  for (int i = 0; i < 1000; ++i) {
    const double v = std::uniform_real_distribution{-4.0, 4.0}(random);
    const PerAxis demand_v{v + at_speed(one, 0.3 * std::sin(0.01 * i))[0], -v, 0};
    one.tick(demand_v);
    other.tick(demand_v);
    ASSERT_EQ(one.out.drive_v, other.out.drive_v) << i;
    ASSERT_EQ(one.state(), other.state());
  }
  EXPECT_TRUE(one.armed());
}

TEST(ZoneFilter, StopsWithoutAFirstSample) {
  const auto limits = supervisor::limits_of(rig_with("gantry", {wall_at(2)}));
  supervisor::ZoneMemory memory;
  EXPECT_TRUE(supervisor::filter_zones(limits, {}, memory).needs_ramped_stop);
}

TEST(ZoneFilter, CountsATickWithoutASample) {
  const auto limits = supervisor::limits_of(rig_with("gantry", {wall_at(2)}));
  supervisor::ZoneMemory memory;
  supervisor::ZoneInput in{
      .sampled_s = 1, .position = {0.5, 0, 1.5}, .speed = {0.5, 0, 0}, .gate_output_v = {5, 0, 0}};
  supervisor::observe_load(limits, in, memory);
  in.sampled_s = 1.01, in.position[0] = 0.505;
  supervisor::observe_load(limits, in, memory);
  const double fresh_m = supervisor::filter_zones(limits, in, memory).clearance_m;
  in.missing_ticks = 1;
  EXPECT_LT(supervisor::filter_zones(limits, in, memory).clearance_m, fresh_m - 0.005);
}

// The oracle: from random states of motion the simulated crane passes one more tick and makes a ramped stop.
// Its load stays inside the reach that the filter has computed, during the stop and for two swings
// afterwards.
class Bound : public testing::TestWithParam<const char*> {};

struct Tried {
  double share = 0;  // largest distance of the load from the middle / radius of the reach
  bool moved = false;
};

Tried try_stop(std::uint64_t seed, const std::string& name) {
  std::mt19937_64 random{seed};
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution{low, high}(random);
  };
  auto nominal = rig_with(name, {wall_at(-50)});
  nominal.clearance.load_radius_m = 0;
  auto truth = nominal;
  truth.start.cable_length_offset_m = between(-0.09, 0.09) * nominal.start.position[plant::kHoist];
  truth.start.swing_radial_rad = between(-0.3, 0.3);
  if (name != "gantry") truth.start.swing_tangential_rad = between(-0.3, 0.3);
  truth.plant.load_mass_kg *= between(0.5, 1.5);
  for (auto* start : {&nominal.start, &truth.start}) start->position[plant::kTrolley] = 0.7;
  GuardedCrane crane{truth, nominal};
  PerAxis wanted{}, volts{};
  for (int i = 0, n = static_cast<int>(between(5, 80)); i < n && crane.armed(); ++i) {
    if (i % 20 == 0)
      for (std::size_t k = 0; k < 3; ++k) wanted[k] = between(-1, 1) * crane.limits.axis[k].volt_limit_v;
    volts = {wanted[0], name == "gantry" ? 0 : wanted[1], 0.3 * wanted[2]};
    crane.tick(volts);
  }
  if (!crane.armed()) return {};
  const supervisor::ZoneInput in{.sampled_s = crane.memory.motion.sampled_s,
                                 .position = crane.memory.motion.position,
                                 .speed = crane.memory.motion.speed,
                                 .swing_radial_rad = crane.input.sample.swing_radial_rad,
                                 .swing_tangential_rad = crane.input.sample.swing_tangential_rad,
                                 .applied_v = crane.input.sample.applied_v,
                                 .gate_output_v = crane.out.drive_v};
  const auto reach = supervisor::ramped_stop_space(crane.limits, in, crane.memory.zones);
  crane.limits.zones = {wall_at(0)};
  crane.limits.zones[0].size_x_m = 100;
  Tried tried{.moved = true};
  for (int i = 0; i < 500; ++i) {
    crane.tick(volts);
    const auto load = on_cable(crane.truth(), 1, 0);
    tried.share =
        std::max(tried.share, std::hypot(load[0] - reach.x_m, load[1] - reach.y_m) / reach.radius_m);
    if (load[2] < reach.lowest_m) tried.share = 2;
  }
  return tried;
}

TEST_P(Bound, EnclosesTheLoadOfEveryRampedStop) {
  constexpr std::uint64_t kSeeds = 400;
  double largest = 0, sum = 0;
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Tried tried = try_stop(seed, GetParam());
    EXPECT_LT(tried.share, 1) << "seed " << seed;
    largest = std::max(largest, tried.share);
    sum += tried.share;
    moved += tried.moved ? 1 : 0;
  }
  std::cout << GetParam() << ": seeds 1 to " << kSeeds << ", " << moved
            << " stops; distance of the load / radius of the reach: largest " << largest << ", mean "
            << sum / moved << '\n';
  EXPECT_GT(moved, 200);
  EXPECT_GT(sum / moved, 0.3) << "the bound is useless when it is much too large";
}

INSTANTIATE_TEST_SUITE_P(Zones, Bound, testing::Values("virginia_tech_tower", "gantry"),
                         [](const auto& rig) { return std::string{rig.param}; });

}  // namespace
}  // namespace crane::zones_test
