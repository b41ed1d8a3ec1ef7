/// Data sets in the form of their files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "write.hpp"

namespace mujoco_truth {
namespace {

Physics gantry() {
  Physics p;
  p.rig.kind = Kind::gantry;
  p.rig.load_mass_kg = 2.5;
  p.rig.trolley_mass_kg = 3;
  p.rig.drive[kTrolley] = {true, 12, 1.3, 2, 3, 0.8, 0.9, -1.5, 1.5, 1e5};
  p.rig.swing_counts_per_rad = 3000;
  p.presliding_m = 1e-5;
  return p;
}

RunPlan short_plan() {
  RunPlan plan;
  plan.duration_s = 9;
  plan.amplitude = 0.5;
  return plan;
}

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

TEST(MujocoData, IsEqualForEqualSeedsAndDiffersForOtherSeeds) {
  const auto a = recorded(gantry(), {}, short_plan()), b = recorded(gantry(), {}, short_plan());
  RunPlan other = short_plan();
  other.seed = 2;
  const auto c = recorded(gantry(), {}, other);
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->rows.back().position, b->rows.back().position);
  EXPECT_NE(a->rows.back().position, c->rows.back().position);
}

TEST(MujocoData, AFaultLeavesDisturbanceNoiseAndRowTimesAsTheyWere) {
  Nuisance nuisance;
  nuisance.jitter = 0.3;
  nuisance.dropped = 0.1;
  Physics worse = gantry();
  // visible in the data; without anti-swing control, the offset does not change the motion
  worse.sensor.swing_offset_rad[kRadial] = 0.1;
  const auto a = recorded(gantry(), nuisance, short_plan()), b = recorded(worse, nuisance, short_plan());
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->rows.size(), b->rows.size());
  EXPECT_LT(a->rows.size(), 870u);  // of 900
  for (std::size_t i = 0; i < a->rows.size(); ++i) {
    EXPECT_EQ(a->rows[i].time_s, b->rows[i].time_s);
    EXPECT_EQ(a->rows[i].position, b->rows[i].position);
    EXPECT_NEAR(b->rows[i].swing[0] - a->rows[i].swing[0], 0.1, 1.01 / 3000);  // tolerance of one count
  }
}

/// Every fault of the list changes the measurements of a rig that can have it; with the amount 0 it changes
/// nothing.
TEST(MujocoData, EveryFaultShowsInAWindowAndIsNothingAtAmountZero) {
  Physics tower = gantry();
  tower.rig.kind = Kind::tower;
  tower.rig.tangential = true;
  tower.rig.drive[kTrolley].low_m = 0.1, tower.rig.drive[kTrolley].high_m = 1.7;
  tower.rig.drive[kSlew] = {true, 8, 1.2, 0.3, 0.25, 0.6, 0.6, -3, 3, 2e4};
  const auto run = recorded(tower, {}, short_plan());
  ASSERT_TRUE(run);
  const Visibility visibility(tower, {*run});
  Chance chance(1, "");
  for (const FaultKind& kind : fault_kinds()) {
    const auto axes = axes_of(kind, tower.rig);
    ASSERT_FALSE(axes.empty()) << kind.name;
    Fault fault = drawn_fault(kind, axes.front(), tower.rig, chance);
    fault.amount = std::copysign(most_of(fault, tower.rig), fault.amount);
    EXPECT_GT(visibility.size({fault}), 0.2) << kind.name;
    fault.amount = 0;
    EXPECT_LT(visibility.size({fault}), 1e-9) << kind.name;
  }
}

TEST(MujocoData, WritesTheAnswerBesideTheDataWithTheSizeThatWasAskedFor) {
  const auto directory =
      std::filesystem::temp_directory_path() / ("mujoco_data_" + std::to_string(::getpid()));
  const Set set = made({"test", 5}, 1, false);
  ASSERT_EQ(set.kind, SetKind::single);
  write(set, directory, directory / "truth.json");
  const auto truth = nlohmann::json::parse(text_of(directory / "truth.json"));
  EXPECT_EQ(truth.at("kind"), "single");
  ASSERT_EQ(truth.at("effects").size(), 1u);
  EXPECT_GT(truth["effects"][0].at("size"), 0.7 * truth["effects"][0].at("wanted_size").get<double>());
  std::istringstream csv(text_of(directory / "train_1.csv"));
  std::string header;
  std::getline(csv, header);
  EXPECT_EQ(header.find("nan"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(directory / "test_1.csv"));
  EXPECT_TRUE(std::filesystem::exists(directory / "rig.toml"));
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace mujoco_truth
