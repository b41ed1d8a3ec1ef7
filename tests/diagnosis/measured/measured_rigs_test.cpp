/// Rigs of other laboratories (SOURCE.md). The rig files do not contain the effects that their authors
/// or a careful fit found.
#include <gmock/gmock.h>

#include "cli/diagnosis_data.hpp"
#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {
namespace {

using testing::AllOf;
using testing::Gt;
using testing::Lt;

Diagnosis diagnosed(const std::string& rig_name, const std::vector<std::string>& train_pieces,
                    const std::vector<std::string>& test_pieces) {
  const std::string prefix = std::string{CRANE_MEASURED} + "/" + rig_name;
  const auto rig = configuration::load_rig(prefix + ".toml");
  const auto mapping = load_mapping(prefix + "_mapping.toml");
  const auto paths = [&](const std::vector<std::string>& pieces) {
    std::vector<std::string> files;
    for (const std::string& piece : pieces) files.push_back(prefix + "_" + piece + ".csv");
    return files;
  };
  const auto data = cli::read_diagnosis_data(paths(train_pieces), paths(test_pieces), mapping, rig);
  return diagnose(rig, data.train, data.test);
}

/// "cause.parameter" to value.
std::map<std::string, double> values_of(const Diagnosis& found) {
  std::map<std::string, double> values;
  for (const Cause& cause : found.causes)
    for (const Estimate& e : cause.parameters) values[cause.name + "." + e.name] = e.value;
  return values;
}

/// A careful fit of two point masses: share 0.43, arms of 0.168 m and 0.196 m.
void expect_second_arm(const Diagnosis& found) {
  EXPECT_EQ(found.verdict, Verdict::named) << found.sentence;
  auto values = values_of(found);
  EXPECT_THAT(values["double_pendulum.lower_share"], AllOf(Gt(0.38), Lt(0.48))) << found.sentence;
  EXPECT_THAT(values["double_pendulum.lower_length_m"], AllOf(Gt(0.17), Lt(0.22)));
  EXPECT_THAT(0.3031 - values["double_pendulum.hook_raised_m"], AllOf(Gt(0.145), Lt(0.19)));
}

TEST(MeasuredDoublePendulum, HasASecondArmInWideSwings) {
  const Diagnosis found = diagnosed("uw_double_pendulum", {"3", "5"}, {"4"});
  expect_second_arm(found);
  EXPECT_GT(found.held_out.baseline_rms.at("swing_radial_rad"), 0.08);
  EXPECT_LT(found.held_out.extended_rms.at("swing_radial_rad"), 0.012);
}

TEST(MeasuredDoublePendulum, HasASecondArmInSmallSwings) {
  const Diagnosis found = diagnosed("uw_double_pendulum", {"5"}, {"6"});
  expect_second_arm(found);
  EXPECT_LT(found.held_out.extended_rms.at("swing_radial_rad"),
            found.held_out.baseline_rms.at("swing_radial_rad"));
}

/// A careful fit: gain of the driver 0.83, dry friction 0.15 N m, viscous friction almost 0 instead of the
/// 0.047 N m s/rad of the rig file.
TEST(MeasuredDrivenPendulum, HasAWeakMotorAndDryFriction) {
  const Diagnosis found =
      diagnosed("dfki_pendulum", {"energy_shaping", "constant_torque", "ddp"}, {"sac", "direct_collocation"});
  EXPECT_EQ(found.verdict, Verdict::parameter) << found.sentence;
  auto values = values_of(found);
  EXPECT_THAT(values["motor_gain.factor"], AllOf(Gt(0.80), Lt(0.85))) << found.sentence;
  EXPECT_THAT(values["coulomb_friction.level_v"], AllOf(Gt(0.12), Lt(0.18)));
  EXPECT_THAT(values["viscous_friction.vspm"], AllOf(Gt(-0.0475), Lt(-0.03)));
  EXPECT_GT(found.held_out.baseline_rms.at("slew_angle_rad"), 0.035);
  EXPECT_LT(found.held_out.extended_rms.at("slew_angle_rad"), 0.020);
}

}  // namespace
}  // namespace crane::diagnosis
