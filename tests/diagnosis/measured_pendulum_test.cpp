/// A real pendulum (data/SOURCE.md), two pieces of its free decay.
#include <gmock/gmock.h>

#include "cli/diagnosis_data.hpp"
#include "crane/diagnosis/diagnosis.hpp"

namespace crane::diagnosis {
namespace {

TEST(MeasuredPendulum, LacksFrictionAndNothingThatPushes) {
  const auto rig = runtime::load_rig(std::filesystem::path{CRANE_RIGS} / "uw_pendulum.toml");
  const auto mapping = load_mapping(std::filesystem::path{CRANE_MAPPINGS} / "uw_pendulum.toml");
  const std::string folder = CRANE_MEASURED;
  const auto data = cli::read_diagnosis_data({folder + "/uw_pendulum_id1.csv"},
                                             {folder + "/uw_pendulum_vad1.csv"}, mapping, rig);
  const Diagnosis found = diagnose(rig, data.train, data.test);
  // The rig file has no friction at all, and a free decay is nothing but its effect.
  EXPECT_THAT(found.verdict, testing::AnyOf(Verdict::named, Verdict::ambiguous)) << found.sentence;
  ASSERT_FALSE(found.causes.empty());
  EXPECT_THAT(found.causes[0].name,
              testing::AnyOf("swing_pivot_friction", "load_linear_drag", "load_quadratic_drag"));
  for (const Cause& cause : found.causes) {
    if (cause.name != "swing_pivot_friction" && !cause.name.starts_with("load_")) continue;
    for (const Estimate& e : cause.parameters) EXPECT_GE(e.value, 0) << e.name << " would drive the pendulum";
  }
  // Nine seconds later the swing without friction is a third too large and far out of step.
  EXPECT_LT(found.held_out.whole_extended_rms.at("swing_radial_rad"),
            0.5 * found.held_out.whole_baseline_rms.at("swing_radial_rad"));
}

}  // namespace
}  // namespace crane::diagnosis
