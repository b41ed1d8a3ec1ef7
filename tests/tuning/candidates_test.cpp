/// The candidates have keys of the rig file, and give rig files without problems.
#include "tuning/candidates.hpp"

#include <gtest/gtest.h>

#include <set>

#include "crane/control/law.hpp"
#include "stack/data_files.hpp"

namespace crane::tuning {
namespace {

TEST(Candidates, AreDifferentAndGiveRigFilesWithoutProblems) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  std::set<std::string> labels;
  for (const auto& candidate : candidates()) {
    labels.insert(candidate.label());
    ASSERT_NE(control::find_controller(candidate.controller), nullptr) << candidate.label();
    const auto changed = with_candidate(rig, candidate);
    EXPECT_NO_THROW((void)configuration::parse_rig(configuration::to_toml(changed), candidate.label()));
  }
  EXPECT_EQ(labels.size(), candidates().size());
  EXPECT_GE(labels.size(), 60U);
}

TEST(Candidates, SetTheirKeys) {
  const auto rig = configuration::load_rig(stack::find_rig("gantry"));
  const auto changed = with_candidate(rig, {"time_optimal", {{"planned_swing_rad", 0.1}}, true});
  EXPECT_EQ(changed.controller, "time_optimal");
  EXPECT_EQ(changed.planning.planned_swing_rad, 0.1);
  EXPECT_TRUE(changed.design.swing_observer);
  EXPECT_EQ(with_candidate(rig, {"none", {{"tracking_proportional", 64}}}).design.tracking_derivative, 16);
  EXPECT_THROW((void)with_candidate(rig, {"none", {{"no_such_key", 1}}}), std::logic_error);
}

}  // namespace
}  // namespace crane::tuning
