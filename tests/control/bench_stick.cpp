/// Residual swing, stop time and stopping distance after the release of the stick for each shaper, over
/// random histories that end at full speed. The load is the pendulum of space_pendulum.hpp.
///   bench_stick [HISTORIES]    default 1000
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "space_pendulum.hpp"
#include "stick_history.hpp"

namespace {

using namespace crane::control;
using namespace crane::control::test;

struct Stop {
  double residual_deg = 0;  ///< swing that remains when the reference is at rest
  double time_s = 0, distance = 0;
};

struct Motions {
  const char* name;
  std::array<bool, kAxes> used;
};

/// A history of 4 s, 2 s at full speed, and the release.
Stop stop_after(const StickLimits& limits, const Motions& motions, double cable_ratio, unsigned seed) {
  const double to_deg = 180 / std::numbers::pi;
  StickMemory memory;
  Reference at;
  at[kTrolley].position = 1.0, at[kHoist].position = 1.0;
  begin(limits, at, memory);
  SpacePendulum load{cable_ratio};
  RandomStick stick{seed, motions.used, 1.5};
  const auto tick = [&](const std::array<double, kAxes>& share) {
    const Reference next = step(limits, speeds(limits, share), memory);
    load.step(at, next, limits.period_s);
    at = next;
  };
  for (double t = 0; t < 4; t += limits.period_s) tick(stick.next(limits.period_s));
  std::array<double, kAxes> full{};
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& axis = limits.axis[i];
    const bool up = at[i].position < (axis.low + axis.high) / 2;
    full[i] = motions.used[i] ? (up ? 1 : -1) : 0;
  }
  constexpr double kFull_s = 2;
  for (double t = 0; t < kFull_s; t += limits.period_s) tick(full);
  Stop stop;
  const std::size_t axis = motions.used[kTrolley] ? kTrolley : kSlew;
  const double from = at[axis].position;
  for (; !at_rest(memory); stop.time_s += limits.period_s) tick({});
  stop.distance = std::abs(at[axis].position - from);
  stop.residual_deg = load.residual_rad() * to_deg;
  return stop;
}

double share_of(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

int main(int argc, char** argv) {
  const int histories = argc > 1 ? std::atoi(argv[1]) : 1000;
  constexpr std::array kShapings{std::pair{"raw", Shaping::none}, std::pair{"zv", Shaping::zv},
                                 std::pair{"zvd", Shaping::zvd}, std::pair{"ei", Shaping::ei}};
  constexpr std::array kMotions{
      Motions{"trolley", {true, false, false}}, Motions{"trolley, hoist", {true, false, true}},
      Motions{"slew", {false, true, false}}, Motions{"trolley, slew", {true, true, false}}};
  std::printf(
      "| motion | cable | shaper | residual swing, median | 99 %% | largest [deg] | stop time [s] | stop "
      "distance "
      "|\n|---|---|---|---|---|---|---|---|\n");
  for (const auto& motions : kMotions)
    for (const double ratio : {1.0, 0.8, 1.2})
      for (const auto& [name, shaping] : kShapings) {
        std::vector<double> swing, time, distance;
        for (int i = 0; i < histories; ++i) {
          const auto stop =
              stop_after(tower_stick(shaping, motions.used), motions, ratio, static_cast<unsigned>(i));
          swing.push_back(stop.residual_deg), time.push_back(stop.time_s), distance.push_back(stop.distance);
        }
        std::printf("| %s | %+.0f %% | %s | %.3f | %.3f | %.3f | %.2f | %.3f |\n", motions.name,
                    100 * ratio - 100, name, share_of(swing, 0.5), share_of(swing, 0.99), share_of(swing, 1),
                    share_of(time, 0.5), share_of(distance, 0.5));
      }
}
