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

MotionProfile motion_profile_of(const std::vector<double>& position, double period_s, std::size_t first,
                                std::size_t rows) {
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
    profile.push_back({std::exp(-std::pow(speed(row, kSpeedRows) / kSlowSpeed, 2)), phase});
  }
  return profile;
}

}  // namespace crane::diagnosis
