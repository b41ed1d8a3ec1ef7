#include "force/position_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parallel.hpp"
#include "replay/travel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr std::size_t kPlaces = 400;
/// Of a line of the travelled distance.
constexpr double kSpacing = 0.25;
/// Five waves over the travel; longer ones are friction that depends on position.
constexpr std::size_t kFirst = 20;

struct Wave {
  double power = 0;
  Vector2d amplitude = Vector2d::Zero();  ///< of cosine and sine
};

Wave wave_of(const Pieces& drive, double per_length) {
  Explained all{2};
  for (const Piece& piece : drive.all) {
    const std::vector<double>& position = (*drive.runs)[piece.run].motion[drive.output].position;
    MatrixXd waves(static_cast<Index>(piece.rows), 2);
    for (Index k = 0; k < waves.rows(); ++k) {
      const double turn =
          2 * std::numbers::pi * per_length * position[piece.first + static_cast<std::size_t>(k)];
      waves(k, 0) = std::cos(turn), waves(k, 1) = std::sin(turn);
    }
    all += explained(drive, piece, std::move(waves));
  }
  const Vector2d amplitude = wave_amplitude(all);
  return {all.pull.dot(amplitude), amplitude};
}

}  // namespace

std::vector<PositionWave> strongest_waves(const Pieces& drive, std::size_t count) {
  const double travel = travel_of(*drive.runs, drive.output).width();
  if (drive.all.empty() || !(travel > 0)) return {};
  std::vector<Wave> lines(kPlaces);
  parallel_for(kPlaces, [&](std::size_t line) {
    if (line + 1 >= kFirst) lines[line] = wave_of(drive, kSpacing * static_cast<double>(line) / travel);
  });
  std::vector<std::size_t> peaks;
  for (std::size_t line = kFirst; line + 1 < kPlaces; ++line)
    if (lines[line].power >= lines[line - 1].power && lines[line].power >= lines[line + 1].power)
      peaks.push_back(line);
  std::sort(peaks.begin(), peaks.end(),
            [&](std::size_t a, std::size_t b) { return lines[a].power > lines[b].power; });
  std::vector<PositionWave> waves;
  for (std::size_t i = 0; i < std::min(count, peaks.size()); ++i) {
    // a sin(x + psi) = a sin(psi) cos(x) + a cos(psi) sin(x)
    const Vector2d& amplitude = lines[peaks[i]].amplitude;
    waves.push_back({travel / (kSpacing * static_cast<double>(peaks[i])), amplitude.norm(),
                     std::atan2(amplitude[0], amplitude[1])});
  }
  return waves;
}

}  // namespace crane::diagnosis
