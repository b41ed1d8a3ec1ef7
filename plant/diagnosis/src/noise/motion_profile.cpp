#include "noise/motion_profile.hpp"

#include <algorithm>
#include <cmath>

namespace crane::diagnosis {
namespace {

/// m/s or rad/s. Below kSlowSpeed the time of stick and slip cannot be predicted. Below kTurningSpeed, from
/// row to row, the axis turns or stops. Below kStillSpeed, for several rows, it is at rest.
constexpr double kSlowSpeed = 0.02, kTurningSpeed = 2e-3, kStillSpeed = 1e-3;
/// Half widths in rows: of a speed, of a rest.
constexpr std::size_t kSpeedRows = 3, kStillRows = 5;

}  // namespace

MotionProfile motion_profile_of(const PreparedRun& run, Output drive, std::size_t first, std::size_t rows) {
  const std::vector<double>&position = run.on_grid[drive], &inaccuracy = run.speed_inaccuracy[drive];
  const double period_s = run.run.period_s;
  const std::size_t last = position.size() - 1;
  const auto speed = [&](std::size_t row, std::size_t half) {
    const std::size_t from = row - std::min(row, half), to = std::min(row + half, last);
    return std::abs(position[to] - position[from]) / (static_cast<double>(to - from) * period_s);
  };
  MotionProfile profile;
  for (std::size_t row = first; row < first + rows; ++row) {
    double fastest = 0;
    for (std::size_t near = row - std::min(row, kStillRows); near <= std::min(row + kStillRows, last); ++near)
      fastest = std::max(fastest, speed(near, kSpeedRows));
    const MotionPhase phase = fastest < kStillSpeed           ? MotionPhase::standing
                              : speed(row, 1) < kTurningSpeed ? MotionPhase::turning
                                                              : MotionPhase::moving;
    profile.push_back({.slowness = std::exp(-std::pow(speed(row, kSpeedRows) / kSlowSpeed, 2)),
                       .phase = phase,
                       .measured = run.run.is_measured(drive, row),
                       .speed_unknown = run.run.may_have_lost_edge(drive, row),
                       .speed_inaccuracy = inaccuracy.empty() ? 0 : inaccuracy[row]});
  }
  return profile;
}

}  // namespace crane::diagnosis
