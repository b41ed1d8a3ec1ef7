/// The adaptation without a crane: conditions that freeze it, and inputs of every size.
#include "crane/control/adaptation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "adapted_crane.hpp"

namespace crane::control::test {
namespace {

/// The test sets the inputs.
class Frozen : public testing::Test {
 protected:
  Frozen() {
    input_.measured.position = {0.5, 0.1, 1};
    input_.consecutive = true;
    for (int i = 0; i < 5; ++i) adaptation_.step(input_);
  }
  AdaptationFreeze reason(const AdaptationInput& input) {
    adaptation_.step(input);
    return adaptation_.report().axis[kTrolley].freeze;
  }
  AdaptationInput input_;
  Adaptation adaptation_{adapted_tower().design};
};

TEST_F(Frozen, AtRest) { EXPECT_EQ(reason(input_), AdaptationFreeze::standstill); }

TEST_F(Frozen, WithAClosedBrake) {
  input_.brake_closed[kTrolley] = true;
  EXPECT_EQ(reason(input_), AdaptationFreeze::brake);
  EXPECT_EQ(adaptation_.report().axis[kSlew].freeze, AdaptationFreeze::standstill);
}

TEST_F(Frozen, WhenTheGateAppliesAnotherVoltage) {
  input_.demand_v[kTrolley] = 1;
  EXPECT_EQ(reason(input_), AdaptationFreeze::not_executed);
}

TEST_F(Frozen, AtTheVoltageLimit) {
  input_.demand_v[kTrolley] = 12;
  input_.measured.applied_v[kTrolley] = 10;
  EXPECT_EQ(reason(input_), AdaptationFreeze::saturation);
}

TEST_F(Frozen, WithALargeSwing) {
  input_.measured.swing_tangential_rad = 0.4;
  EXPECT_EQ(reason(input_), AdaptationFreeze::swing);
}

TEST_F(Frozen, WhileTheCableMoves) {
  input_.measured.speed[kHoist] = 0.2;
  for (int i = 0; i < 3; ++i) adaptation_.step(input_);
  EXPECT_EQ(reason(input_), AdaptationFreeze::hoist);
}

TEST_F(Frozen, AfterAMissingTickAndForValuesThatAreNotFinite) {
  input_.consecutive = false;
  EXPECT_EQ(reason(input_), AdaptationFreeze::gap);
  input_.consecutive = true;
  input_.measured.position[kTrolley] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reason(input_), AdaptationFreeze::gap);
  for (const double value :
       {adaptation_.friction()[kTrolley].coulomb_positive_v, adaptation_.report().load_mass_kg.value,
        adaptation_.report().pendulum_length_m.value})
    EXPECT_TRUE(std::isfinite(value));
}

TEST_F(Frozen, KeepsEveryLevel) {
  input_.brake_closed.fill(true);
  std::mt19937 random{11};
  std::uniform_real_distribution<double> value{-1, 1};
  const auto before = adaptation_.friction();
  for (int i = 0; i < 500; ++i) {
    input_.measured.position[kTrolley] += 0.01 * value(random);
    input_.measured.applied_v[kTrolley] = 5 * value(random);
    input_.demand_v = input_.measured.applied_v;
    adaptation_.step(input_);
  }
  EXPECT_EQ(adaptation_.friction(), before);
}

TEST(Adaptation, LeavesAnAxisWithoutCompensationAlone) {
  auto design = adapted_tower().design;
  design.friction[kSlew].factor = 0;
  const Adaptation adaptation{design};
  EXPECT_EQ(adaptation.report().axis[kSlew].phase, AdaptationPhase::off);
  EXPECT_EQ(adaptation.friction(), design.friction);
}

TEST(Adaptation, GivesFiniteLevelsForEveryFiniteInput) {
  std::mt19937 random{5};
  std::uniform_real_distribution<double> exponent{-6, 12}, side{-1, 1};
  Adaptation adaptation{adapted_tower().design};
  const auto number = [&] { return std::copysign(std::pow(10, exponent(random)), side(random)); };
  for (int i = 0; i < 20000; ++i) {
    AdaptationInput input;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      input.measured.position[axis] = number();
      input.measured.speed[axis] = number();
      input.measured.applied_v[axis] = input.demand_v[axis] = side(random) * 9;
    }
    input.measured.swing_radial_rad = 0.3 * side(random);
    input.measured.swing_tangential_rad = 0.3 * side(random);
    input.consecutive = true;
    adaptation.step(input);
    for (const auto& f : adaptation.friction())
      ASSERT_TRUE(std::isfinite(f.coulomb_positive_v + f.coulomb_negative_v + f.viscous_positive_vspm +
                                f.viscous_negative_vspm + f.stiction_positive_v + f.stiction_negative_v))
          << i;
    ASSERT_TRUE(
        std::isfinite(adaptation.report().load_mass_kg.value + adaptation.report().pendulum_length_m.value))
        << i;
  }
}

}  // namespace
}  // namespace crane::control::test
