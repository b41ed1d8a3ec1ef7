// Duration of the search for paths, and of the paths compared with straight moves without zones.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>

#include "crane/configuration/path_space.hpp"

namespace crane {
namespace {

using control::PathOutcome;

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

control::Zone random_zone(std::mt19937& bits, int number) {
  const auto in = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(bits()) / 4294967296.0;
  };
  const double radius_m = in(0.3, 1.3), angle_rad = in(-2.7, 2.7), size_m = in(0.02, 0.2);
  return {.name = std::to_string(number),
          .position_x_m = radius_m * std::cos(angle_rad),
          .position_y_m = radius_m * std::sin(angle_rad),
          .size_x_m = size_m,
          .size_y_m = size_m,
          .top_m = in(0.6, 2)};
}

plant::PerAxis random_place(const control::PathSpace& space, std::mt19937& bits) {
  plant::PerAxis place{};
  for (int i = 0; i < 100; ++i) {
    for (std::size_t axis = 0; axis < plant::kAxes; ++axis)
      place[axis] = space.axis[axis].low + (space.axis[axis].high - space.axis[axis].low) *
                                               static_cast<double>(bits()) / 4294967296.0;
    if (control::closest_zone(space, place).clearance_m >= control::kPassClearance_m) break;
  }
  return place;
}

void measure(const control::PathSpace& rig, int zones) {
  std::vector<double> searched_ms;
  int straight = 0, no_path = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    std::mt19937 bits{seed};
    auto space = rig;
    for (int i = 0; i < zones; ++i) space.zones.push_back(random_zone(bits, i));
    const auto from = random_place(space, bits), to = random_place(space, bits);
    const double begin_ms = cpu_ms();
    const auto path = control::path_to(space, from, to);
    searched_ms.push_back(cpu_ms() - begin_ms);
    straight += path.outcome == PathOutcome::straight ? 1 : 0;
    no_path += path.outcome == PathOutcome::no_path || path.outcome == PathOutcome::target_inside ? 1 : 0;
  }
  std::ranges::sort(searched_ms);
  std::printf("%5d zones: p50 %7.3f ms, p99 %7.3f ms, max %7.3f ms; %d straight, %d without path, of 400\n",
              zones, searched_ms[searched_ms.size() / 2], searched_ms[searched_ms.size() * 99 / 100],
              searched_ms.back(), straight, no_path);
}

}  // namespace
}  // namespace crane

int main() {
  auto rig = crane::configuration::load_rig(CRANE_RIGS "/virginia_tech_tower_silo.toml");
  rig.zones.clear();
  const auto space = crane::configuration::path_space_of(rig);
  for (const int zones : {1, 10, 100}) crane::measure(space, zones);
  return 0;
}
