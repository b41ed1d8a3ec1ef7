#include "crane/plant/term.hpp"

#include <gmock/gmock.h>

#include <iostream>
#include <numbers>
#include <set>

#include "crane/plant/model.hpp"
#include "lagrange_oracle.hpp"

namespace crane::plant {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

double power_w(const Parameters& p, const State& s, const Model& with, const Model& without) {
  // power of the terms from the accelerations that they add: P = q' M dq''
  const Accelerations a = with.accelerations(s, {}), b = without.accelerations(s, {});
  const Eigen::Vector4d added{a.trolley_mps2 - b.trolley_mps2, a.radial_radps2 - b.radial_radps2,
                              a.slew_radps2 - b.slew_radps2, a.tangential_radps2 - b.tangential_radps2};
  const Eigen::Vector4d rates{s.trolley_mps, s.radial_radps, s.slew_radps, s.tangential_radps};
  return rates.dot(mass_matrix(p, s) * added);
}

std::array<double, 5> numbers(const Measurement& m) {
  return {m.trolley_m, m.slew_rad, m.cable_m, m.radial_rad, m.tangential_rad};
}

TEST(Terms, WithTheirDefaultsDoNothing) {
  std::mt19937 random{test::kSeed};
  for (const TermKind& kind : term_kinds()) {
    for (const std::string_view axis : kind.axes) {
      SCOPED_TRACE(std::string{kind.name} + " " + std::string{axis});
      Model with{{}, {{std::string{kind.name}, std::string{axis}, {}}}};
      Model without{Parameters{}};
      EXPECT_EQ(with.inner_coordinates(), 0U);
      EXPECT_EQ(with.parameters().load_mass_kg, Parameters{}.load_mass_kg);
      for (int tick = 0; tick < 5; ++tick) {
        const State s = test::random_state(random);
        const PerAxis command{1.0 - tick, -2.0 * tick, 3};
        EXPECT_EQ(with.drive_voltage(command), command);
        EXPECT_EQ(with.friction_v(s, {1, 1, 1}), PerAxis{});
        EXPECT_EQ(test::values(with.accelerations(s, {})), test::values(without.accelerations(s, {})));
        EXPECT_EQ(numbers(with.measure(s)), numbers(without.measure(s)));
      }
    }
  }
}

TEST(Terms, StayFiniteWithAnyParametersInTheirRanges) {
  std::mt19937 random{test::kSeed};
  std::cout << "seed " << test::kSeed << '\n';
  const auto in = [&random](double low, double high) {
    return std::uniform_real_distribution{low, high}(random);
  };
  const auto drawn = [&](const TermParameter& p) {
    const double share = std::array{0.0, 1.0, in(0, 1)}[random() % 3];  // includes the ends of the range
    return p.low + share * (p.high - p.low);
  };
  const auto finite = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  for (const TermKind& kind : term_kinds()) {
    SCOPED_TRACE(kind.name);
    for (int i = 0; i < 100; ++i) {
      TermSetting setting{std::string{kind.name}, std::string{kind.axes[random() % kind.axes.size()]}, {}};
      for (const TermParameter& p : kind.parameters) setting.parameters[std::string{p.name}] = drawn(p);
      if (kind.name == "payload_mass") setting.parameters["delta_kg"] = in(-2, 1000);
      Model model{{}, {setting}};
      Actuation actuation;
      actuation.drive_v = {1, 2, 3};
      InnerState inner{};
      for (Inner& own : inner) own = {in(-0.5, 0.5), in(-5, 5)};
      const State s = test::random_state(random);
      InnerAccelerations own{};
      EXPECT_TRUE(finite(model.drive_voltage({in(-10, 10), in(-10, 10), in(-10, 10)})));
      EXPECT_TRUE(finite(model.friction_v(s, {1, -1, 1})));
      EXPECT_TRUE(finite(test::values(model.accelerations(s, actuation, inner, own))));
      EXPECT_TRUE(finite(own));
      EXPECT_TRUE(finite(numbers(model.measure(s))));
    }
  }
}

TEST(Terms, HaveDescriptionsAndUniqueNames) {
  std::set<std::string_view> names;
  for (const TermKind& kind : term_kinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_FALSE(kind.equation.empty() || kind.effect.empty() || kind.axes.empty()) << kind.name;
    for (const TermParameter& p : kind.parameters) {
      EXPECT_FALSE(p.unit.empty() || p.meaning.empty()) << kind.name << "." << p.name;
      EXPECT_TRUE(p.low <= p.default_value && p.default_value <= p.high) << kind.name << "." << p.name;
    }
    EXPECT_EQ(find_term(kind.name), &kind);
  }
  EXPECT_EQ(find_term("phlogiston"), nullptr);
}

TEST(Terms, ThatDissipateNeverAddEnergy) {
  const std::vector<std::vector<TermSetting>> dissipative{
      {{"drive_friction",
        "trolley",
        {{"viscous_positive_vspm", 2}, {"coulomb_negative_v", 1}, {"stiction_positive_v", 3}}}},
      {{"drive_friction",
        "slew",
        {{"viscous_negative_vspm", 2}, {"coulomb_positive_v", 1}, {"stiction_negative_v", 3}}}},
      {{"stribeck_friction", "trolley", {{"excess_v", 1}, {"decay_speed", 1}}}},
      {{"position_dependent_friction", "slew", {{"amplitude_v", 1}, {"wavelength", 0.4}}}},
      {{"load_linear_drag", "", {{"coefficient_nspm", 0.5}}}},
      {{"load_quadratic_drag", "", {{"coefficient_ns2pm2", 0.5}}}},
      {{"swing_pivot_friction", "", {{"viscous_nmsprad", 0.1}, {"coulomb_nm", 0.1}}}},
  };
  std::mt19937 random{test::kSeed};
  const Parameters p;
  const Model without{p};
  for (const auto& terms : dissipative) {
    SCOPED_TRACE(terms[0].name);
    const Model with{p, terms};
    double most_w = 0;
    for (int i = 0; i < 200; ++i) {
      State s = test::random_state(random);
      s.cable_mps = 0;  // the hoist absorbs drag along the cable, because its motion is prescribed
      const double power = power_w(p, s, with, without);
      EXPECT_LT(power, 1e-9);
      most_w = std::min(most_w, power);
    }
    EXPECT_LT(most_w, -1e-3);  // the terms have an effect
  }
}

TEST(Terms, ADeadZoneTakesItsWidthFromEitherSide) {
  Model model{{}, {{"command_dead_zone", "trolley", {{"width_v", 0.3}}}}};
  EXPECT_EQ(model.drive_voltage({0.3, 0.1, 0})[kTrolley], 0);
  EXPECT_NEAR(model.drive_voltage({1, 0, 0})[kTrolley], 0.7, 1e-15);
  EXPECT_NEAR(model.drive_voltage({-1, 0, 0})[kTrolley], -0.7, 1e-15);
}

TEST(Terms, ASaturationLimitsEitherSide) {
  Model model{{}, {{"command_saturation", "slew", {{"limit_v", 2.5}}}}};
  EXPECT_EQ(model.drive_voltage({9, 2.4, 0})[kSlew], 2.4);
  EXPECT_EQ(model.drive_voltage({9, 2.6, 0})[kSlew], 2.5);
  EXPECT_EQ(model.drive_voltage({9, -10, 0})[kSlew], -2.5);
  EXPECT_EQ(model.drive_voltage({9, -10, 0})[kTrolley], 9);
}

TEST(Terms, ARateLimitGivesTheMeanOfTheRampInEveryTick) {
  constexpr double kRate_vps = 130, kPeriod_s = 0.01;
  Model model{{}, {{"command_rate_limit", "trolley", {{"rate_vps", kRate_vps}}}}, kPeriod_s};
  double v = 0;
  for (const double command : {0.7, 3.0, 3.0, 3.0, -1.1, -1.1, -1.1, -1.1, -1.0}) {
    constexpr int kParts = 100000;
    constexpr double kStep_v = kRate_vps * kPeriod_s / kParts;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) {  // the ramp in small steps
      const double before = v;
      v = std::abs(command - v) < kStep_v ? command : v + std::copysign(kStep_v, command - v);
      sum += 0.5 * (before + v);
    }
    EXPECT_NEAR(model.drive_voltage({command, 0, 0})[kTrolley], sum / kParts, 1e-4);
  }
}

/// After a step V from rest, the integral of the output is V t - V^2 / (2 r), and its slope V^2 / (2 r^2).
TEST(Terms, ARateLimitDelaysAStepByHalfItsRamp) {
  constexpr double kStep_v = 4, kPeriod_s = 0.01;
  const auto integral = [](double rate_vps) {
    Model model{{}, {{"command_rate_limit", "trolley", {{"rate_vps", rate_vps}}}}, kPeriod_s};
    double sum = 0;
    for (int tick = 0; tick < 40; ++tick) sum += kPeriod_s * model.drive_voltage({kStep_v, 0, 0})[kTrolley];
    return sum;
  };
  for (const double rate : {17.0, 133.0, 1e5}) {
    EXPECT_NEAR(integral(rate), kStep_v * 0.4 - kStep_v * kStep_v / (2 * rate), 1e-12);
    const double change = 1e-3 * rate;
    EXPECT_NEAR((integral(rate + change) - integral(rate - change)) / (2 * change),
                kStep_v * kStep_v / (2 * rate * rate), 2e-6 * kStep_v * kStep_v / (2 * rate * rate) + 1e-13);
  }
}

TEST(Terms, ADelayHoldsTheCommandBackByTicksAndTheirFractions) {
  Model model{{}, {{"command_delay", "slew", {{"delay_s", 0.025}}}}, 0.01};
  std::vector<double> output;
  for (int tick = 0; tick < 5; ++tick) output.push_back(model.drive_voltage({0, 4, 0})[kSlew]);
  EXPECT_THAT(output, ElementsAre(0, 0, 2, 4, 4));
}

TEST(Terms, ALagGivesTheMeanOfTheExponentialResponseInEveryTick) {
  constexpr double kTau_s = 0.017, kPeriod_s = 0.01;
  Model model{{}, {{"actuator_lag", "slew", {{"time_constant_s", kTau_s}}}}, kPeriod_s};
  constexpr std::array kCommands{1.0, 1.0, -2.0, 0.5};
  double v = 0;
  for (const double command : kCommands) {
    constexpr int kParts = 100000;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) {  // midpoint rule on the differential equation
      const double middle = v + (command - v) * 0.5 * kPeriod_s / kParts / kTau_s;
      v += (command - middle) * kPeriod_s / kParts / kTau_s;
      sum += middle;
    }
    EXPECT_NEAR(model.drive_voltage({0, command, 0})[kSlew], sum / kParts, 1e-7);
  }
}

TEST(Terms, ARaisedJibPullsTowardsTheTowerAndTheLoadHangsInLineWithGravity) {
  constexpr double kAngle = 0.1;
  const Parameters p;
  const Model tilted{p, {{"jib_tilt", "", {{"angle_rad", kAngle}}}}};
  Actuation held;
  held.locks.axis = {true, true, true};
  const Accelerations hanging = tilted.accelerations({.trolley_m = 1, .radial_rad = kAngle}, held);
  EXPECT_NEAR(hanging.radial_radps2, 0, 1e-12);  // phi = a: towards the tower
  EXPECT_NEAR(tilted.accelerations({.trolley_m = 1}, held).radial_radps2, p.gravity_mps2 * std::sin(kAngle),
              1e-12);
  const Accelerations rolling = tilted.accelerations({.trolley_m = 1, .radial_rad = kAngle}, {});
  const double weight_n = (p.trolley_mass_kg + p.load_mass_kg) * p.gravity_mps2 * std::sin(kAngle);
  // gravity acts on both masses; the load pulls through its cable, which swings as the trolley moves
  const double inertia = p.trolley_inertia_kg + p.load_mass_kg * std::pow(std::sin(kAngle), 2);
  EXPECT_NEAR(rolling.trolley_mps2, -weight_n / inertia, 1e-12);
}

TEST(Terms, PayloadMassIsAddedToTheLoadAndMustLeaveSomething) {
  EXPECT_EQ((Model{{}, {{"payload_mass", "", {{"delta_kg", 0.5}}}}}.parameters().load_mass_kg), 2.5);
  EXPECT_THROW((Model{{}, {{"payload_mass", "", {{"delta_kg", -2.5}}}}}), std::invalid_argument);
}

TEST(Terms, CommandTermsActInTheOrderOfTheRigFile) {
  const TermSetting gain{"motor_gain", "slew", {{"factor", 0.8}}};
  const TermSetting offset{"command_offset", "slew", {{"offset_v", 0.5}}};
  Model gain_first{{}, {gain, offset}};
  Model offset_first{{}, {offset, gain}};
  EXPECT_NEAR(gain_first.drive_voltage({1, 2, 3})[kSlew], 2 * 0.8 + 0.5, 1e-15);
  EXPECT_NEAR(offset_first.drive_voltage({1, 2, 3})[kSlew], (2 + 0.5) * 0.8, 1e-15);
  EXPECT_EQ(gain_first.drive_voltage({1, 2, 3})[kTrolley], 1);
}

TEST(Terms, WindDeflectsTheLoadInItsDirectionForAnySlewAngle) {
  constexpr double kRight = std::numbers::pi / 2;
  const Model wind{{}, {{"steady_wind", "", {{"force_n", 2}, {"direction_rad", kRight}}}}};
  Actuation held;
  held.locks.axis = {true, true, true};
  const Accelerations across = wind.accelerations({.trolley_m = 1, .slew_rad = 0}, held);
  EXPECT_NEAR(across.tangential_radps2, 1, 1e-12);  // F / (m L), ahead of +slew
  EXPECT_NEAR(across.radial_radps2, 0, 1e-12);
  const Accelerations along = wind.accelerations({.trolley_m = 1, .slew_rad = kRight}, held);
  EXPECT_NEAR(along.radial_radps2, -1, 1e-12);  // away from the tower
  EXPECT_NEAR(along.tangential_radps2, 0, 1e-12);
}

TEST(Terms, PivotFrictionActsOnTheSwingItIsNamedFor) {
  const Model radial{{}, {{"swing_pivot_friction", "radial", {{"viscous_nmsprad", 0.2}}}}};
  Actuation held;
  held.locks.axis = {true, true, true};
  const Accelerations a = radial.accelerations({.radial_radps = 1, .tangential_radps = 0}, held);
  EXPECT_NEAR(a.radial_radps2, -0.1, 1e-12);  // b w / (m L^2)
  const Accelerations b = radial.accelerations({.radial_radps = 0, .tangential_radps = 1}, held);
  EXPECT_NEAR(b.tangential_radps2, 0, 1e-12);
}

TEST(Terms, ListEveryProblemOfEverySetting) {
  const std::vector<TermSetting> bad{
      {"phlogiston", "", {}},
      {"drive_friction", "radial", {{"coulomb_positive_v", -1}, {"colour", 3}}},
      {"steady_wind", "", {{"force_n", std::numeric_limits<double>::quiet_NaN()}}},
  };
  EXPECT_THAT(
      problems(bad),
      ElementsAre(
          HasSubstr("terms[0] phlogiston: no term has this name"),
          HasSubstr("terms[1] drive_friction: axis = \"radial\": must be one of \"trolley\""),
          HasSubstr("colour = 3: the term has no such parameter; must be one of viscous_positive_vspm"),
          "terms[1] drive_friction: coulomb_positive_v = -1: must be in [0, 10] V",
          HasSubstr("terms[2] steady_wind: force_n = nan")));
  EXPECT_THROW(Model({}, bad), std::invalid_argument);
  EXPECT_THROW((void)make_term(bad[1]), std::invalid_argument);
}

}  // namespace
}  // namespace crane::plant
