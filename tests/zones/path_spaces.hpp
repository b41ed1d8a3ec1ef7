#pragma once
/// Rigs and random zones for the tests of the path search.
#include <cmath>
#include <random>
#include <string>

#include "crane/control/path.hpp"

namespace crane::control {

inline constexpr double kGravity = 9.81;

inline PathSpace tower() {
  PathSpace space;
  space.clearance = {.load_radius_m = 0.05, .suspension_height_m = 2, .cable_error = 0.1, .wind_mps2 = 0.1};
  space.gravity_mps2 = kGravity;
  space.axis[0] = {.present = true, .low = 0.19, .high = 1.31, .speed = 0.5, .acceleration = 1};
  space.axis[1] = {.present = true, .low = -2.74, .high = 2.74, .speed = 1, .acceleration = 2};
  space.axis[2] = {.present = true, .low = 0.4, .high = 1.5, .speed = 0.2, .acceleration = 0.5};
  return space;
}
inline PathSpace gantry() {
  auto space = tower();
  space.axis[0].low = 0.2, space.axis[0].high = 2.8;
  space.axis[1] = {};
  return space;
}

class Random {
 public:
  explicit Random(unsigned seed) : bits_{seed} {}
  double in(double low, double high) {
    return low + (high - low) * static_cast<double>(bits_()) / 4294967296.0;
  }
  int below(int count) { return static_cast<int>(in(0, count)); }

 private:
  std::mt19937 bits_;
};

inline void add_zones(PathSpace& space, Random& random, int count) {
  const bool slews = space.axis[1].present;
  for (int i = 0; i < count; ++i) {
    const double radius = random.in(0.3, slews ? 1.3 : 2.6), angle = slews ? random.in(-3, 3) : 0;
    Zone zone{.name = "zone " + std::to_string(i),
              .shape = random.below(2) == 0 ? ZoneShape::box : ZoneShape::cylinder,
              .position_x_m = radius * std::cos(angle),
              .position_y_m = radius * std::sin(angle),
              .size_x_m = random.in(0.02, 0.5),
              .size_y_m = random.in(0.02, 0.5),
              .radius_m = random.in(0.01, 0.25),
              .top_m = random.in(0.6, 2)};
    space.zones.push_back(zone);
  }
}

}  // namespace crane::control
