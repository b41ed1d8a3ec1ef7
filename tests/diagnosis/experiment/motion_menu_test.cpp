#include "experiment/motion_menu.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "crane/experiment/scenario.hpp"
#include "experiment/safe_run.hpp"

namespace crane::diagnosis {
namespace {

const std::filesystem::path kRigFiles{CRANE_RIGS};

double span(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

class MotionMenu : public testing::TestWithParam<const char*> {
 protected:
  configuration::Rig rig_ = configuration::load_rig(kRigFiles / (std::string{GetParam()} + ".toml"));
};

TEST_P(MotionMenu, KeepsToTravelSpeedAndAccelerationOfTheReference) {
  for (const SafeMotion& motion : motion_menu(rig_))
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      const configuration::Drive& drive = rig_.drives[axis];
      if (!drive.present) continue;
      for (double t = 0; t < motion.duration_s; t += 0.01) {
        const auto wanted = motion.reference(axis, t);
        ASSERT_GE(wanted.position, drive.low_limit + drive.soft_margin) << motion.name << ' ' << t;
        ASSERT_LE(wanted.position, drive.high_limit - drive.soft_margin) << motion.name << ' ' << t;
        ASSERT_LE(std::abs(wanted.speed), drive.reference_speed) << motion.name << ' ' << t;
        ASSERT_LE(std::abs(wanted.acceleration), drive.reference_acceleration) << motion.name << ' ' << t;
      }
    }
}

TEST_P(MotionMenu, EveryMotionIsAScenarioOfTheRig) {
  for (const SafeMotion& motion : motion_menu(rig_)) {
    const auto scenario =
        experiment::parse_scenario(scenario_text(motion, rig_), motion.name + ".toml", &rig_);
    EXPECT_EQ(scenario.description, motion.description);
    ASSERT_EQ(scenario.excitations.size(), motion.references.size()) << motion.name;
    for (std::size_t i = 0; i < motion.references.size(); ++i)
      for (const double t : {1.0, 4.0, 7.7})
        EXPECT_DOUBLE_EQ(scenario.excitations[i].reference.at(t).position,
                         motion.references[i].reference.at(t).position);
  }
}

TEST_P(MotionMenu, TheNominalRigStaysInsideItsLimits) {
  for (const SafeMotion& motion : motion_menu(rig_)) {
    Crane crane{rig_.plant, rig_.terms};
    crane.parameters.load_mass_kg = motion.load_mass_kg;
    const auto run = safe_run(rig_, crane, motion);
    ASSERT_TRUE(run) << motion.name;
    for (const plant::Axis axis : {plant::kTrolley, plant::kSlew}) {
      std::vector<double> reference;
      for (std::size_t k = 0; k < run->run.rows(); ++k)
        reference.push_back(motion.reference(axis, static_cast<double>(k) * rig_.period_s).position);
      // The loop is slow, and friction stops the axis before the end of a creeping motion.
      if (rig_.drives[axis].present) {
        EXPECT_GE(span(run->run.measured[axis]), 0.6 * span(reference)) << motion.name;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Rigs, MotionMenu,
                         testing::Values("virginia_tech_tower", "gantry", "drive_axis", "pendulum"),
                         [](const auto& entry) { return std::string{entry.param}; });

TEST(MotionMenu, OfTheDissertationsRigIsInTheScenarioFiles) {
  const auto rig = configuration::load_rig(kRigFiles / "virginia_tech_tower.toml");
  for (const SafeMotion& motion : motion_menu(rig)) {
    std::ifstream file{std::filesystem::path{CRANE_SCENARIOS} / ("experiment_" + motion.name + ".toml")};
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(text, scenario_text(motion, rig)) << motion.name;
  }
}

}  // namespace
}  // namespace crane::diagnosis
