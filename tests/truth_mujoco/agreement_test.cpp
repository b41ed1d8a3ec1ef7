/// Compares the faults of the MuJoCo cranes with the terms of the project, with the parameters of the answer.
/// If the term explains the fault, names, units and signs of the answer are correct.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "crane.hpp"
#include "crane/simulator/integrator.hpp"
#include "fault.hpp"

namespace mujoco_truth {
namespace {

namespace plant = crane::plant;
using Motion = std::vector<std::array<double, 4>>;  ///< trolley, slew, radial, tangential

constexpr int kTicks = 400;  // 4 s, open loop

std::array<double, 2> command(int tick) {
  const double t = tick * 0.01;
  return {2.5 * std::sin(2.1 * t) + 1.5 * std::sin(5.3 * t),
          1.8 * std::cos(1.7 * t) - 1.2 * std::sin(4.1 * t)};
}

Physics tower() {
  Physics p;
  p.rig.tangential = true;
  p.rig.load_mass_kg = 2;
  p.rig.trolley_mass_kg = 1.97;
  p.rig.drive[kTrolley] = {true, 22.46, 2, 1.5, 6, 0.9, 1.2, -9, 9, 0};
  p.rig.drive[kSlew] = {true, 7.2, 1.14, 0.15, 0.05, 0.7, 0.6, -9, 9, 0};
  p.presliding_m = 1e-5;
  return p;
}

Motion by_mujoco(const Physics& physics) {
  Crane crane(physics);
  Pose start;
  start.position = {0.6, 0.2};
  start.swing = {0.1, -0.05};
  crane.start(start);
  Motion motion;
  for (int i = 0; i < kTicks; ++i) {
    crane.command(command(i));
    crane.advance(0.01 * (i + 1), {}, {});
    const Pose pose = crane.pose();
    motion.push_back({pose.position[0], pose.position[1], pose.swing[0], pose.swing[1]});
  }
  return motion;
}

plant::TermSetting friction(const std::string& axis, double b_plus, double b_minus, double c_plus,
                            double c_minus) {
  return {"drive_friction",
          axis,
          {{"viscous_positive_vspm", b_plus},
           {"viscous_negative_vspm", b_minus},
           {"coulomb_positive_v", c_plus},
           {"coulomb_negative_v", c_minus}}};
}

/// The model of the project for the same rig, with default values and one additional term.
Motion by_plant(const std::vector<plant::TermSetting>& more) {
  std::vector<plant::TermSetting> terms{friction("trolley", 1.5, 6, 0.9, 1.2),
                                        friction("slew", 0.15, 0.05, 0.7, 0.6)};
  terms.insert(terms.end(), more.begin(), more.end());
  const plant::Model model{plant::Parameters{}, terms};
  crane::simulator::Integrator integrator{model, {.relative = 1e-8, .absolute = 1e-8}};
  plant::State state{.trolley_m = 0.6, .radial_rad = 0.1, .slew_rad = 0.2, .tangential_rad = -0.05};
  Motion motion;
  for (int i = 0; i < kTicks; ++i) {
    const auto v = command(i);
    plant::Actuation actuation;
    actuation.drive_v = {v[0], v[1], 0};
    integrator.advance(state, actuation, 0.01);
    motion.push_back({state.trolley_m, state.slew_rad, state.radial_rad, state.tangential_rad});
  }
  return motion;
}

double distance(const Motion& a, const Motion& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) sum += (a[i][k] - b[i][k]) * (a[i][k] - b[i][k]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(MujocoAndPlant, MoveAlikeWithoutAFault) {
  // Bristles of 10 um in MuJoCo, a smoothed step of 0.5 mm/s in the project: each reversal causes a
  // difference of a millisecond.
  EXPECT_LT(distance(by_mujoco(tower()), by_plant({})), 3e-3);
}

/// Terms that act on forces and bodies. Terms of command and sensor are not part of this model.
void expect_terms_to_explain(const std::set<std::string>& faults) {
  Chance chance(3, "agreement");
  const Motion without = by_plant({});
  for (const FaultKind& kind : fault_kinds()) {
    if (!faults.contains(kind.name)) continue;
    for (const std::string& axis : axes_of(kind, tower().rig)) {
      Fault fault = drawn_fault(kind, axis, tower().rig, chance);
      fault.amount = std::copysign(0.5 * most_of(fault, tower().rig), fault.amount);
      const plant::TermSetting term{fault.name, axis, fault.parameters()};
      const Motion faulty = by_mujoco(with(tower(), {fault}));
      const double wrong = distance(faulty, without), left = distance(faulty, by_plant({term}));
      EXPECT_GT(wrong, 5e-3) << fault.name << " " << axis;
      EXPECT_LT(left, 0.2 * wrong) << fault.name << " " << axis << ": of " << wrong;
    }
  }
}

TEST(MujocoAndPlant, TheTermOfTheAnswerExplainsTheFault) {
  const std::set<std::string> forces{"coulomb_friction",
                                     "viscous_friction",
                                     "direction_asymmetry",
                                     "stribeck_friction",
                                     "position_dependent_friction",
                                     "torque_ripple",
                                     "payload_mass",
                                     "load_linear_drag",
                                     "load_quadratic_drag",
                                     "steady_wind",
                                     "swing_pivot_friction",
                                     "jib_tilt",
                                     "cable_length"};
  expect_terms_to_explain(forces);
}

/// For oscillating structures, the residual with the term is larger than the effect of the fault (0.0722 of
/// 0.0719, 1.02 of 0.048). The answers of these faults are not yet reliable.
TEST(MujocoAndPlant, DISABLED_TheTermsOfOscillatingStructuresExplainTheFault) {
  expect_terms_to_explain({"double_pendulum", "jib_flexibility"});
}

}  // namespace
}  // namespace mujoco_truth
