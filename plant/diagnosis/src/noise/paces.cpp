#include "noise/paces.hpp"

#include <algorithm>
#include <cmath>

namespace crane::diagnosis {
namespace {

/// Speeds in m/s or rad/s. Below kSlow the time of stick and slip cannot be predicted. Below kTurning, from
/// row to row, the axis turns or comes to rest. Below kStill, for several rows, it is at standstill.
constexpr double kSlow = 0.02, kTurning = 2e-3, kStill = 1e-3;
/// Half widths, in rows, over which a speed is taken and a standstill lasts.
constexpr std::size_t kSpeedRows = 3, kStillRows = 5;

}  // namespace

Paces paces_of(const std::vector<double>& position, double period_s, std::size_t first, std::size_t rows) {
  const std::size_t last = position.size() - 1;
  const auto speed = [&](std::size_t row, std::size_t half) {
    const std::size_t from = row - std::min(row, half), to = std::min(row + half, last);
    return std::abs(position[to] - position[from]) / (static_cast<double>(to - from) * period_s);
  };
  Paces paces;
  for (std::size_t row = first; row < first + rows; ++row) {
    double fastest = 0;
    for (std::size_t near = row - std::min(row, kStillRows); near <= std::min(row + kStillRows, last); ++near)
      fastest = std::max(fastest, speed(near, kSpeedRows));
    const Going going = fastest < kStill           ? Going::standing
                        : speed(row, 1) < kTurning ? Going::turning
                                                   : Going::on;
    paces.push_back({std::exp(-std::pow(speed(row, kSpeedRows) / kSlow, 2)), going});
  }
  return paces;
}

}  // namespace crane::diagnosis
