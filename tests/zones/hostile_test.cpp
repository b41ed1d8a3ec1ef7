// Random hostile voltages before the gate of the real supervisor, with the simulated crane behind it: the
// load is never inside a zone. CRANE_ZONE_RUNS gives the number of runs per rig, CRANE_ZONE_SEED the first
// seed.
#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <map>
#include <random>

#include "guarded_crane.hpp"

namespace crane::zones_test {
namespace {

using Random = std::mt19937_64;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution{low, high}(random);
}
bool chance(Random& random, double probability) { return std::bernoulli_distribution{probability}(random); }

control::Zone random_zone(Random& random, const configuration::Rig& rig, std::size_t i) {
  control::Zone zone{.name = "zone " + std::to_string(i)};
  const auto& trolley = rig.drives[plant::kTrolley];
  const double radius_m = between(random, trolley.low_limit, trolley.high_limit + 0.4);
  const double angle_rad = rig.kind == configuration::RigKind::tower ? between(random, -2, 2) : 0;
  zone.position_x_m = radius_m * std::cos(angle_rad);
  zone.position_y_m = radius_m * std::sin(angle_rad);
  zone.shape = chance(random, 0.5) ? control::ZoneShape::box : control::ZoneShape::cylinder;
  zone.size_x_m = between(random, 0.02, 0.6);
  zone.size_y_m = between(random, 0.02, 0.6);
  zone.radius_m = between(random, 0.01, 0.3);
  zone.bottom_m = rig.clearance.suspension_height_m - 3;
  zone.top_m = zone.bottom_m + 3 - between(random, 0.1, 1.5) * rig.start.position[plant::kHoist];
  return zone;
}

/// The rig file of the supervisor: one to three zones beside the start.
configuration::Rig nominal_rig(Random& random, const std::string& name) {
  auto rig = deployed_rig(name);
  rig.clearance = {.load_radius_m = between(random, 0.02, 0.1),
                   .suspension_height_m = 2,
                   .cable_error = 0.1,
                   .wind_mps2 = 0.25};
  const auto& trolley = rig.drives[plant::kTrolley];
  rig.start.position[plant::kTrolley] =
      between(random, trolley.low_limit + trolley.soft_margin, trolley.high_limit - trolley.soft_margin);
  const auto& start = rig.start.position;
  const auto reach =
      control::resting_space(rig.clearance, rig.plant.gravity_mps2, start[0], start[1], start[2]);
  for (std::size_t i = 0, wanted = 1 + random() % 3; rig.zones.size() < wanted; ++i) {
    const auto zone = random_zone(random, rig, i);
    if (control::clearance_m(zone, reach, rig.clearance.suspension_height_m) > 0.05)
      rig.zones.push_back(zone);
  }
  return rig;
}

/// The crane itself: another cable, wind, another load, less friction.
configuration::Rig true_rig(Random& random, const configuration::Rig& nominal) {
  auto rig = nominal;
  const double error = chance(random, 0.5) ? (chance(random, 0.5) ? 0.1 : -0.1) : between(random, -0.1, 0.1);
  rig.start.cable_length_offset_m = 0.9 * error * rig.start.position[plant::kHoist];
  rig.plant.load_mass_kg *= between(random, 0.5, 1.5);
  rig.start.swing_radial_rad = between(random, -0.05, 0.05);
  const double force_n = between(random, 0, nominal.clearance.wind_mps2) * rig.plant.load_mass_kg;
  rig.terms.push_back(
      {.name = "steady_wind",
       .axis = "",
       .parameters = {{"force_n", force_n}, {"direction_rad", between(random, -3.14, 3.14)}}});
  const double friction = between(random, 0, 1.5);
  for (auto& term : rig.terms)
    for (auto& [name, value] : term.parameters)
      if (term.name == "drive_friction" && (name.starts_with("coulomb") || name.starts_with("viscous")))
        value *= friction;
  return rig;
}

/// Voltages of one run. Each kind holds its choice for a random time.
class Hostile {
 public:
  /// @param creep  speeds of all episodes of the run; nothing: random voltages
  Hostile(Random& random, const GuardedCrane& crane, const std::optional<PerAxis>& creep)
      : random_{random},
        crane_{crane},
        kind_{creep ? 2 : random() % 5},
        creep_{creep},
        cable_m_{crane.input.sample.position[plant::kHoist]} {}

  PerAxis next() {
    if (left_ticks_-- <= 0) choose();
    PerAxis volts{};
    for (std::size_t i = 0; i < plant::kAxes; ++i)
      if (crane_.limits.axis[i].present) volts[i] = voltage(i);
    // The offset of the cable is within its permitted share for lengths above 0.9 of the first one.
    const double cable_m = crane_.input.sample.position[plant::kHoist];
    if (cable_m < 0.95 * cable_m_) volts[plant::kHoist] = std::abs(volts[plant::kHoist]);
    return volts;
  }

 private:
  void choose() {
    left_ticks_ = static_cast<int>(between(random_, 2, 120));
    for (std::size_t i = 0; i < plant::kAxes; ++i) {
      const auto& axis = crane_.limits.axis[i];
      target_[i] = between(random_, -1, 1) * axis.max_speed * 0.8;
      volts_[i] = between(random_, -1, 1) * axis.volt_limit_v;
    }
    if (creep_) target_ = *creep_;
    if (creep_) return;
    if (chance(random_, 0.7)) volts_[plant::kHoist] = target_[plant::kHoist] = 0;
    if (chance(random_, 0.4)) volts_[plant::kSlew] = target_[plant::kSlew] = 0;
  }
  double voltage(std::size_t axis) {
    const double most_v = crane_.limits.axis[axis].volt_limit_v;
    const double follow =
        0.1 * most_v * (target_[axis] - crane_.speed(axis)) / crane_.limits.axis[axis].max_speed * 20;
    const double swing =
        axis == 0 ? -crane_.input.sample.swing_radial_rad : crane_.input.sample.swing_tangential_rad;
    switch (kind_) {
      case 0:  // constant voltages
        return volts_[axis];
      case 1:  // full voltages to and fro
        return std::copysign(most_v, volts_[axis]);
      case 2:  // constant speeds
        return follow;
      case 3:  // pumps the swing
        return axis == plant::kHoist ? follow : follow + 2 * most_v * swing;
      default:  // slow speeds with noise
        return 0.3 * follow + between(random_, -0.2, 0.2) * most_v;
    }
  }
  Random& random_;
  const GuardedCrane& crane_;
  std::uint64_t kind_;
  std::optional<PerAxis> creep_;
  double cable_m_;  // at the start
  int left_ticks_ = 0;
  PerAxis target_{}, volts_{};
};

constexpr int kEpisodes = 20;

struct Result {
  double closest_m = std::numeric_limits<double>::infinity();
  std::map<std::string, int> causes;  // of the ends of the episodes
  double driven_s = 0;
};

/// Speeds that lead slowly towards something, in each episode again: a reset and an arming must not permit a
/// further step into a zone.
std::optional<PerAxis> creep_of(Random& random, const supervisor::Limits& limits) {
  if (!chance(random, 0.3)) return std::nullopt;
  PerAxis speeds{};
  for (const std::size_t axis : {plant::kTrolley, plant::kSlew})
    speeds[axis] = between(random, -0.3, 0.3) * limits.axis[axis].max_speed;
  return speeds;
}

/// Episodes of 1 to 4 s of hostile voltages, with an occasional emergency stop, lost demands and lost states.
/// After each, three seconds with closed brakes, then reset and arm.
class HostileRun {
 public:
  HostileRun(std::uint64_t seed, const std::string& name, bool guarded)
      : random_{seed},
        nominal_{nominal_rig(random_, name)},
        crane_{true_rig(random_, nominal_), nominal_},
        creep_{creep_of(random_, crane_.limits)} {
    if (!guarded) crane_.limits.zones.clear();
  }
  Result result() {
    for (int episode = 0; episode < kEpisodes && crane_.armed(); ++episode) {
      drive();
      rest();
      rearm();
    }
    return result_;
  }

 private:
  void tick(const PerAxis& demand_v) {
    crane_.tick(demand_v);
    result_.closest_m =
        std::min(result_.closest_m, gap_m(nominal_.zones, nominal_.clearance, crane_.truth()));
  }
  void drive() {
    Hostile hostile{random_, crane_, creep_};
    const int ticks = static_cast<int>(between(random_, 100, 400));
    const int estop_tick = chance(random_, 0.2) ? static_cast<int>(between(random_, 10, ticks)) : -1;
    const bool loses = chance(random_, 0.2);
    for (int i = 0; i < ticks && crane_.armed(); ++i) {
      crane_.demand_arrives = !(loses && chance(random_, 0.05));
      crane_.state_arrives = !(loses && chance(random_, 0.05));
      if (i == estop_tick) crane_.press_estop(true);
      tick(hostile.next());
      result_.driven_s += nominal_.period_s;
    }
    crane_.demand_arrives = crane_.state_arrives = true;
    ++result_.causes[supervisor::name_of(crane_.cause())];
  }
  void rest() {
    if (crane_.armed()) crane_.press_estop(true);
    for (int i = 0; i < 300; ++i) tick({});
    crane_.press_estop(false);
  }
  void rearm() {
    using supervisor::Request;
    for (int i = 0; i < 110; ++i) tick({});
    for (const Request request : {Request::reset, Request::arm}) {
      crane_.input.requests[static_cast<std::size_t>(request)] = true;
      tick({});
      crane_.input.requests = {};
      for (int i = 0; i < 20; ++i) tick({});
    }
  }
  Random random_;
  configuration::Rig nominal_;
  GuardedCrane crane_;
  std::optional<PerAxis> creep_;
  Result result_;
};

class HostileRuns : public testing::TestWithParam<const char*> {};

TEST_P(HostileRuns, NeverLeadTheLoadIntoAZone) {
  const auto first = number("CRANE_ZONE_SEED", 1), runs = number("CRANE_ZONE_RUNS", 60);
  double closest_m = std::numeric_limits<double>::infinity(), driven_s = 0;
  std::uint64_t closest_seed = 0, inside = 0;
  std::map<std::string, int> causes;
  const auto began = std::chrono::steady_clock::now();
  for (auto seed = first; seed < first + runs; ++seed) {
    const Result result = HostileRun{seed, GetParam(), true}.result();
    for (const auto& [cause, count] : result.causes) causes[cause] += count;
    driven_s += result.driven_s;
    if (result.closest_m < 0) ++inside;
    if (result.closest_m < closest_m) closest_m = result.closest_m, closest_seed = seed;
    EXPECT_GT(result.closest_m, 0) << GetParam() << ", seed " << seed;
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  std::cout << GetParam() << ": seeds " << first << " to " << first + runs - 1 << ", " << inside
            << " inside, closest " << closest_m << " m (seed " << closest_seed << "), " << driven_s
            << " s driven, " << took.count() << " s\n";
  for (const auto& [cause, count] : causes) std::cout << "  " << cause << ": " << count << '\n';
  EXPECT_GT(causes["ZONE"], static_cast<int>(runs / 20)) << "the runs must reach the zones";
}

TEST_P(HostileRuns, EnterZonesWithoutTheFilter) {
  int inside = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    if (HostileRun{seed, GetParam(), false}.result().closest_m < 0) ++inside;
  EXPECT_GT(inside, 10);
}

/// A crane inside the margin may leave. Twenty successive armings must not lead into the zone.
TEST(HostileArming, InsideTheMarginLeadsNoCloserToTheZoneEachTime) {
  auto rig = deployed_rig("virginia_tech_tower");
  rig.clearance = {.load_radius_m = 0.05, .suspension_height_m = 2, .cable_error = 0.1, .wind_mps2 = 0.25};
  const double wall_m = rig.start.position[plant::kTrolley] + 0.09;  // margin: 0.106 m
  rig.zones = {{.name = "wall", .position_x_m = wall_m + 0.5, .size_x_m = 1, .size_y_m = 4, .top_m = 2}};
  GuardedCrane crane{rig, rig};
  double closest_m = std::numeric_limits<double>::infinity();
  int zone_stops = 0;
  const auto tick = [&](const PerAxis& demand_v) {
    crane.tick(demand_v);
    closest_m = std::min(closest_m, gap_m(rig.zones, rig.clearance, crane.truth()));
  };
  for (int arming = 0; arming < 20; ++arming) {
    for (int i = 0; i < 200 && crane.armed(); ++i)
      tick({10 * (0.02 - crane.speed(plant::kTrolley)) + 1, 0, 0});
    zone_stops += crane.cause() == supervisor::Cause::zone ? 1 : 0;
    for (int i = 0; i < 410; ++i) tick({});
    for (const auto request : {supervisor::Request::reset, supervisor::Request::arm}) {
      crane.input.requests[static_cast<std::size_t>(request)] = true;
      tick({});
      crane.input.requests = {};
      for (int i = 0; i < 20; ++i) tick({});
    }
  }
  EXPECT_GT(closest_m, 0);
  EXPECT_GT(zone_stops, 0);
  std::cout << "closest " << closest_m << " m, " << zone_stops << " stops\n";
}

INSTANTIATE_TEST_SUITE_P(Zones, HostileRuns, testing::Values("virginia_tech_tower", "gantry"),
                         [](const auto& rig) { return std::string{rig.param}; });

}  // namespace
}  // namespace crane::zones_test
