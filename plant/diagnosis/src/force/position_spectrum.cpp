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

constexpr std::size_t kLines = 400;
/// Distance of lines, in 1 / travel.
constexpr double kLineSpacing = 0.25;
/// First line: one wave over the travel. A longer wave has the shape of a position force.
constexpr std::size_t kFirstLine = 4;
/// Subdivisions between two lines, so that the phase of the wave fits over the whole travel.
constexpr std::size_t kRefinement = 8;
/// Cosine and sine.
constexpr Index kOfWave = 2;

struct Wave {
  double per_length = 0, power = 0;
  Vector2d amplitude = Vector2d::Zero();  ///< of cosine and sine
};

/// Forces of the quantities of a drive that a rig file states inaccurately: offset, Coulomb friction, viscous
/// friction, gain. Each changes with the direction or the speed, and therefore from place to place like a
/// long wave. The force by a wrong gain is the measured acceleration beside the frictions; the command is not
/// used, because a controller that works against the wave makes the command contain the wave. Responses by
/// piece.
std::vector<MatrixXd> responses_of_known_forces(const Pieces& drive) {
  std::vector<MatrixXd> responses;
  for (const Piece& piece : drive.all) {
    const Motion& motion = (*drive.runs)[piece.run].motion[drive.output];
    MatrixXd forces(static_cast<Index>(piece.rows), 4);
    for (std::size_t k = 0; k < piece.rows; ++k) {
      const double speed = motion.rate[piece.first + k];
      forces.row(static_cast<Index>(k)) << 1, std::copysign(1.0, speed), speed,
          motion.acceleration[piece.first + k];
    }
    responses.push_back(response_to(drive, piece, std::move(forces)));
  }
  return responses;
}

/// The wave of one period, fitted together with the known forces: power is the decrease of the loss beyond
/// that by the known forces alone.
Wave wave_of(const Pieces& drive, const std::vector<MatrixXd>& known, WaveOf of, double per_length) {
  const Index of_known = known[0].cols();
  NormalEquations all{of_known + kOfWave};
  for (std::size_t i = 0; i < drive.all.size(); ++i) {
    const Piece& piece = drive.all[i];
    MatrixXd waves(static_cast<Index>(piece.rows), kOfWave);
    for (std::size_t k = 0; k < piece.rows; ++k) {
      const double middle = 0.5 * (piece.position[k] + piece.position[std::min(k + 1, piece.rows - 1)]);
      const double turn = 2 * std::numbers::pi * per_length * middle;
      const double speed = (*drive.runs)[piece.run].motion[drive.output].rate[piece.first + k];
      const double unit = of == WaveOf::friction ? std::copysign(1.0, speed) : 1.0;
      waves.row(static_cast<Index>(k)) << unit * std::cos(turn), unit * std::sin(turn);
    }
    MatrixXd both(waves.rows(), of_known + kOfWave);
    both << known[i], response_to(drive, piece, std::move(waves));
    all += normal_equations(piece, both);
  }
  const NormalEquations wave = beside_first(all, of_known);
  const Vector2d amplitude = wave_amplitude(wave);
  return {per_length, wave.score.dot(amplitude), amplitude};
}

/// The strongest wave between the neighbours of `peak`.
Wave refined(const Pieces& drive, const std::vector<MatrixXd>& known, WaveOf of, const Wave& peak,
             double spacing) {
  std::vector<Wave> around(2 * kRefinement - 1);
  parallel_for(around.size(), [&](std::size_t i) {
    const double lines = (static_cast<double>(i) + 1) / kRefinement - 1;
    around[i] = wave_of(drive, known, of, peak.per_length + lines * spacing);
  });
  return *std::max_element(around.begin(), around.end(),
                           [](const Wave& a, const Wave& b) { return a.power < b.power; });
}

}  // namespace

std::vector<PositionWave> strongest_waves(const Pieces& drive, std::size_t count, WaveOf of) {
  const double travel = travel_of(*drive.runs, drive.output).width();
  if (drive.all.empty() || !(travel > 0)) return {};
  const double spacing = kLineSpacing / travel;
  const std::vector<MatrixXd> known = responses_of_known_forces(drive);
  std::vector<Wave> lines(kLines);
  parallel_for(kLines, [&](std::size_t line) {
    if (line + 1 >= kFirstLine) lines[line] = wave_of(drive, known, of, spacing * static_cast<double>(line));
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
    const Wave wave = refined(drive, known, of, lines[peaks[i]], spacing);
    waves.push_back(
        {1 / wave.per_length, wave.amplitude.norm(), std::atan2(wave.amplitude[0], wave.amplitude[1])});
  }
  return waves;
}

}  // namespace crane::diagnosis
