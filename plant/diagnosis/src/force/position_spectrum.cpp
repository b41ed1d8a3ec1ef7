#include "force/position_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "force/normal_equations.hpp"
#include "parallel.hpp"
#include "replay/travel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr std::size_t kLines = 400;
/// Distance of lines, in 1 / travel.
constexpr double kLineSpacing = 0.25;
/// Fewest waves over the travel: fewer waves are a position-dependent friction.
constexpr std::size_t kFirstLine = 20;
/// Subdivisions between two lines, so that the phase of the wave fits over the whole travel.
constexpr std::size_t kRefinement = 8;

struct Wave {
  double per_length = 0, power = 0;
  Vector2d amplitude = Vector2d::Zero();  ///< of cosine and sine
};

Wave wave_of(const Pieces& drive, double per_length) {
  NormalEquations all{2};
  for (const Piece& piece : drive.all) {
    MatrixXd waves(static_cast<Index>(piece.rows), 2);
    for (std::size_t k = 0; k < piece.rows; ++k) {
      const double middle = 0.5 * (piece.position[k] + piece.position[std::min(k + 1, piece.rows - 1)]);
      const double turn = 2 * std::numbers::pi * per_length * middle;
      waves.row(static_cast<Index>(k)) << std::cos(turn), std::sin(turn);
    }
    all += normal_equations(drive, piece, std::move(waves));
  }
  const Vector2d amplitude = wave_amplitude(all);
  return {per_length, all.score.dot(amplitude), amplitude};
}

/// The strongest wave between the neighbours of `peak`.
Wave refined(const Pieces& drive, const Wave& peak, double spacing) {
  std::vector<Wave> around(2 * kRefinement - 1);
  parallel_for(around.size(), [&](std::size_t i) {
    const double lines = (static_cast<double>(i) + 1) / kRefinement - 1;
    around[i] = wave_of(drive, peak.per_length + lines * spacing);
  });
  return *std::max_element(around.begin(), around.end(),
                           [](const Wave& a, const Wave& b) { return a.power < b.power; });
}

}  // namespace

std::vector<PositionWave> strongest_waves(const Pieces& drive, std::size_t count) {
  const double travel = travel_of(*drive.runs, drive.output).width();
  if (drive.all.empty() || !(travel > 0)) return {};
  const double spacing = kLineSpacing / travel;
  std::vector<Wave> lines(kLines);
  parallel_for(kLines, [&](std::size_t line) {
    if (line + 1 >= kFirstLine) lines[line] = wave_of(drive, spacing * static_cast<double>(line));
  });
  std::vector<std::size_t> peaks;
  for (std::size_t line = kFirstLine; line + 1 < kLines; ++line)
    if (lines[line].power >= lines[line - 1].power && lines[line].power >= lines[line + 1].power)
      peaks.push_back(line);
  std::sort(peaks.begin(), peaks.end(),
            [&](std::size_t a, std::size_t b) { return lines[a].power > lines[b].power; });
  std::vector<PositionWave> waves;
  for (std::size_t i = 0; i < std::min(count, peaks.size()); ++i) {
    // a sin(x + psi) = a sin(psi) cos(x) + a cos(psi) sin(x)
    const Wave wave = refined(drive, lines[peaks[i]], spacing);
    waves.push_back(
        {1 / wave.per_length, wave.amplitude.norm(), std::atan2(wave.amplitude[0], wave.amplitude[1])});
  }
  return waves;
}

}  // namespace crane::diagnosis
