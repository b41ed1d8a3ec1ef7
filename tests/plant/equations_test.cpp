#include "crane/plant/matrices.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "closed_loop.hpp"
#include "crane/plant/model.hpp"
#include "lagrange_oracle.hpp"

namespace crane::plant {
namespace {

using test::kQ;
using test::kSeed;

/// Rounding of some hundred operations on numbers up to 1e3 stays below 1e-11.
constexpr double kAgreement = 1e-9;
constexpr int kCases = 300;

void expect_lagrange(const Parameters& p, const State& s, const Accelerations& a, const Forces& f,
                     const Locks& locks = {}) {
  const test::Q<double> required = test::required_forces(p, s, a);
  const test::Q<double> given{f.trolley_n, f.radial_nm, f.slew_nm, f.tangential_nm, 0};
  const std::array<bool, 4> locked{locks.axis[kTrolley], locks.radial, locks.axis[kSlew], locks.tangential};
  for (std::size_t j = 0; j < 4; ++j) {
    if (!locked[j]) {
      EXPECT_NEAR(required[j], given[j], kAgreement) << "coordinate " << j;
    }
  }
}

TEST(Equations, FulfilLagrangesEquationsFromPositionsOverGround) {
  std::mt19937 random{kSeed};
  for (unsigned i = 0; i < kCases; ++i) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + " case " + std::to_string(i));
    const Parameters p = test::random_inclined_crane(random, i);
    const State s = test::random_state(random);
    const Forces f = test::random_forces(random);
    const double hoisting = std::uniform_real_distribution{-3.0, 3.0}(random);
    const Accelerations a = accelerations(p, s, f, hoisting);
    EXPECT_EQ(a.cable_mps2, hoisting);
    expect_lagrange(p, s, a, f);
  }
}

TEST(Equations, HoldLockedCoordinatesAndMoveTheOthersByTheReducedEquations) {
  std::mt19937 random{kSeed};
  for (unsigned i = 0; i < kCases; ++i) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + " case " + std::to_string(i));
    const Locks locks{.axis = {(i & 1) != 0, (i & 2) != 0, (i & 4) != 0},
                      .radial = (i & 8) != 0,
                      .tangential = (i & 16) != 0};
    const Parameters p = test::random_inclined_crane(random, i);
    State s = test::random_state(random);
    if (locks.axis[kTrolley]) s.trolley_mps = 0;
    if (locks.axis[kSlew]) s.slew_radps = 0;
    if (locks.axis[kHoist]) s.cable_mps = 0;
    if (locks.radial) s.radial_radps = 0;
    if (locks.tangential) s.tangential_radps = 0;
    const Forces f = test::random_forces(random);
    const Accelerations a = accelerations(p, s, f, 1.5, locks);
    expect_lagrange(p, s, a, f, locks);
    if (locks.axis[kTrolley]) {
      EXPECT_EQ(a.trolley_mps2, 0);
    }
    if (locks.axis[kSlew]) {
      EXPECT_EQ(a.slew_radps2, 0);
    }
    if (locks.axis[kHoist]) {
      EXPECT_EQ(a.cable_mps2, 0);
    }
    if (locks.radial) {
      EXPECT_EQ(a.radial_radps2, 0);
    }
    if (locks.tangential) {
      EXPECT_EQ(a.tangential_radps2, 0);
    }
  }
}

TEST(Equations, MassMatrixIsTheDerivativeOfTheMomenta) {
  std::mt19937 random{kSeed};
  for (unsigned i = 0; i < kCases; ++i) {
    const Parameters p = test::random_inclined_crane(random, i);
    State s = test::random_state(random);
    const Eigen::Matrix4d m = mass_matrix(p, s);
    s.cable_mps = 0;
    const Eigen::Vector4d v{s.trolley_mps, s.radial_radps, s.slew_radps, s.tangential_radps};
    const test::Q<double> momentum = test::momenta(p, s);
    for (int j = 0; j < 4; ++j) EXPECT_NEAR((m * v)[j], momentum[static_cast<std::size_t>(j)], kAgreement);
  }
}

TEST(Equations, AnImpactOfAnAxisConservesTheOtherMomenta) {
  std::mt19937 random{kSeed};
  for (unsigned i = 0; i < kCases; ++i) {
    const Parameters p = test::random_inclined_crane(random, i);
    const State s = test::random_state(random);
    const test::Q<double> before = test::momenta(p, s);
    for (const Axis axis : {kTrolley, kSlew, kHoist}) {
      const State stopped = stop_dead(p, s, axis);
      const test::Q<double> after = test::momenta(p, stopped);
      EXPECT_EQ(speed(stopped, axis), 0);
      for (const std::size_t j : {0U, 1U, 2U, 3U}) {
        if (j != kPositionIndex[axis]) {
          EXPECT_NEAR(after[j], before[j], kAgreement) << "axis " << axis;
        }
      }
    }
  }
}

TEST(Equations, AnImpactOfAnAxisDissipatesEnergy) {
  std::mt19937 random{kSeed};
  for (unsigned i = 0; i < kCases; ++i) {
    const Parameters p = test::random_inclined_crane(random, i);
    State s = test::random_state(random);
    s.cable_mps = 0;  // a moving winch could add energy to the impact
    for (const Axis axis : {kTrolley, kSlew}) EXPECT_LT(energy_j(p, stop_dead(p, s, axis)), energy_j(p, s));
  }
}

TEST(Equations, EnergyIsKineticPlusPotential) {
  std::mt19937 random{kSeed};
  for (unsigned i = 0; i < kCases; ++i) {
    const Parameters p = test::random_inclined_crane(random, i);
    const State s = test::random_state(random);
    // T is quadratic in the rates: 2 T = p q'; L = T - V
    const test::Q<double> momentum = test::momenta(p, s), v = test::rates(s);
    double twice_kinetic = 0;
    for (std::size_t j = 0; j < kQ; ++j) twice_kinetic += momentum[j] * v[j];
    const double lagrangian = test::lagrangian(p, test::coordinates(s), v);
    EXPECT_NEAR(energy_j(p, s), twice_kinetic - lagrangian, kAgreement);
  }
}

TEST(Equations, LoadVelocityIsTheDerivativeOfThePositionOverGround) {
  std::mt19937 random{kSeed};
  for (unsigned i = 0; i < kCases; ++i) {
    const Parameters p = test::random_inclined_crane(random, i);
    const State s = test::random_state(random);
    test::Q<test::Dual<double>> moving;
    for (std::size_t j = 0; j < kQ; ++j) moving[j] = {test::coordinates(s)[j], test::rates(s)[j]};
    const auto load = test::load_over_ground(p, moving);
    const Eigen::Vector3d v = load_velocity_mps(p, s);
    EXPECT_NEAR(v[0], std::cos(s.slew_rad) * load[0].slope + std::sin(s.slew_rad) * load[1].slope,
                kAgreement);
    EXPECT_NEAR(v[1], -std::sin(s.slew_rad) * load[0].slope + std::cos(s.slew_rad) * load[1].slope,
                kAgreement);
    EXPECT_NEAR(v[2], load[2].slope, kAgreement);
  }
}

TEST(Equations, GantryIsTheTowerWithoutSlewAndTangentialSwingAndTheOppositeSignOfTheSwing) {
  std::mt19937 random{kSeed};
  const Locks gantry{.axis = {false, true, false}, .radial = false, .tangential = true};
  for (int i = 0; i < kCases; ++i) {
    const Parameters p = test::random_crane(random);
    State s = test::random_state(random);
    s.tangential_rad = s.tangential_radps = s.slew_radps = 0;
    const double force = 30, hoisting = -1.2;
    const Accelerations tower = accelerations(p, s, {.trolley_n = force}, hoisting, gantry);
    const GantryState opposite{.swing_rad = -s.radial_rad,
                               .swing_radps = -s.radial_radps,
                               .cable_m = s.cable_m,
                               .cable_mps = s.cable_mps};
    const GantryAccelerations plane = gantry_accelerations(p, opposite, hoisting, force);
    EXPECT_NEAR(tower.trolley_mps2, plane.trolley_mps2, kAgreement);
    EXPECT_NEAR(tower.radial_radps2, -plane.swing_radps2, kAgreement);
    // (2.5) and (2.6) as printed
    const double f = -s.radial_rad, fd = -s.radial_radps, m = p.load_mass_kg, l = s.cable_m;
    EXPECT_NEAR((m + p.trolley_inertia_kg) * plane.trolley_mps2 + m * l * plane.swing_radps2 * std::cos(f) +
                    m * hoisting * std::sin(f) + 2 * m * s.cable_mps * fd * std::cos(f) -
                    m * l * fd * fd * std::sin(f),
                force, kAgreement);
    EXPECT_NEAR(l * plane.swing_radps2 + p.gravity_mps2 * std::sin(f) + 2 * s.cable_mps * fd +
                    plane.trolley_mps2 * std::cos(f),
                0, kAgreement);
  }
}

TEST(Equations, WithoutLoadADriveAxisIsAnInertia) {
  Parameters p;
  p.load_mass_kg = 0;
  const State s{.trolley_m = 0.8, .radial_rad = 0.2, .trolley_mps = 0.5, .slew_radps = 0.7};
  const Accelerations a = accelerations(p, s, {.trolley_n = 10, .slew_nm = 3}, 0);
  EXPECT_NEAR(a.trolley_mps2, (10 + 1.97 * 0.8 * 0.49) / 22.46, 1e-12);
  EXPECT_NEAR(a.slew_radps2, (3 - 2 * 0.7 * 0.5 * 1.97 * 0.8) / (7.2 + 1.97 * 0.64), 1e-12);
  EXPECT_EQ(a.radial_radps2, 0);
  EXPECT_EQ(a.tangential_radps2, 0);
}

/// Energy gained minus work done over 4 s by Runge-Kutta steps of h, cable length moved by L''.
double energy_gap_j(double h_s, double hoisting_mps2, const Forces& f, double tilt_rad) {
  Parameters p;
  p.tilt_sine = std::sin(tilt_rad), p.tilt_cosine = std::cos(tilt_rad);
  using Row = Eigen::Matrix<double, 11, 1>;
  const auto slope = [&](double t, const Row& y) {
    StateArray values{};
    std::copy_n(y.data(), kStateSize, values.begin());
    const State s = to_state(values);
    const Accelerations a = accelerations(p, s, f, hoisting_mps2 * std::sin(2 * t));
    Row d;
    d << s.trolley_mps, s.radial_radps, s.slew_radps, s.tangential_radps, s.cable_mps, a.trolley_mps2,
        a.radial_radps2, a.slew_radps2, a.tangential_radps2, a.cable_mps2,
        f.trolley_n * s.trolley_mps + f.slew_nm * s.slew_radps +
            test::required_forces(p, s, a)[4] * s.cable_mps;  // the hoist's work
    return d;
  };
  const State start{.trolley_m = 0.6,
                    .radial_rad = 0.5,
                    .tangential_rad = -0.3,
                    .cable_m = 1.2,
                    .slew_radps = 0.5,
                    .tangential_radps = 0.8,
                    .cable_mps = -0.5 * hoisting_mps2};
  Row y = Row::Zero();
  const StateArray first = to_array(start);
  std::copy(first.begin(), first.end(), y.data());
  const auto steps = std::lround(4 / h_s);
  for (long i = 0; i < steps; ++i) {
    const double t = static_cast<double>(i) * h_s;
    const Row k1 = slope(t, y), k2 = slope(t + h_s / 2, y + h_s / 2 * k1),
              k3 = slope(t + h_s / 2, y + h_s / 2 * k2), k4 = slope(t + h_s, y + h_s * k3);
    y += h_s / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  StateArray last{};
  std::copy_n(y.data(), kStateSize, last.begin());
  return energy_j(p, to_state(last)) - energy_j(p, start) - y[10];
}

TEST(Equations, EnergyChangesByTheWorkOfDrivesAndHoistOnly) {
  struct Case {
    const char* name;
    double hoisting_mps2;
    Forces forces;
    double tilt_rad = 0;
  };
  for (const Case& c : {Case{"free", 0, {}}, Case{"driven", 0, {.trolley_n = 3, .slew_nm = 1}},
                        Case{"driven and hoisting", 0.4, {.trolley_n = 3, .slew_nm = 1}},
                        Case{"tilted, driven and hoisting", 0.4, {.trolley_n = 3, .slew_nm = 1}, 0.2}}) {
    SCOPED_TRACE(c.name);
    const double coarse = std::abs(energy_gap_j(0.008, c.hoisting_mps2, c.forces, c.tilt_rad));
    const double fine = std::abs(energy_gap_j(0.004, c.hoisting_mps2, c.forces, c.tilt_rad));
    EXPECT_LT(fine, 1e-6);         // of about 20 J
    EXPECT_GT(coarse / fine, 12);  // the remaining error is that of the integrator, of order h^4 or higher
    EXPECT_GT(coarse, 1e-12);
  }
}

}  // namespace
}  // namespace crane::plant
