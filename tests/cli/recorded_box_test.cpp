// crane zone learn: the box around recorded places of the hook.
#include "cli/recorded_box.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace crane::cli {
namespace {

msg::State state_at(double trolley_m, double slew_rad, double cable_m) {
  msg::State state{};
  state.trolley_position_m = trolley_m;
  state.slew_angle_rad = slew_rad;
  state.cable_length_m = cable_m;
  for (bool& known : state.position_known) known = true;
  return state;
}

TEST(RecordedBox, EnclosesThePlacesOfTheHook) {
  RecordedBox box{2, 0};
  box.add(state_at(1, 0, 1));
  box.add(state_at(1.2, std::numbers::pi / 2, 1.5));
  const auto zone = box.zone("silo");
  EXPECT_EQ(zone.name, "silo");
  EXPECT_NEAR(zone.position_x_m, 0.5, 1e-12);
  EXPECT_NEAR(zone.size_x_m, 1, 1e-12);
  EXPECT_NEAR(zone.position_y_m, 0.6, 1e-12);
  EXPECT_NEAR(zone.size_y_m, 1.2, 1e-12);
  EXPECT_NEAR(zone.bottom_m, 0.5, 1e-12);
  EXPECT_NEAR(zone.top_m, 1, 1e-12);
}

TEST(RecordedBox, CountsTheSwingAndSkipsUnknownPositions) {
  RecordedBox box{0, 1};
  auto state = state_at(1, 0, 0);
  state.swing_radial_rad = std::numbers::pi / 6;
  box.add(state);
  state.position_known[0] = false;
  box.add(state);
  EXPECT_EQ(box.samples(), 1U);
  EXPECT_EQ(box.skipped(), 1U);
  EXPECT_NEAR(box.zone("a").position_x_m, 0.5, 1e-12);  // towards the tower
}

}  // namespace
}  // namespace crane::cli
