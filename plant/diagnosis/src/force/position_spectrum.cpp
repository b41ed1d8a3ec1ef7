#include "force/position_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "force/normal_equations.hpp"
#include "parallel.hpp"
#include "replay/travel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;

constexpr std::size_t kSpectrumLines = 200;
/// Distance of lines, in 1 / travel.
constexpr double kLineSpacing = 0.5;
/// In half waves over the travel. A peak needs a weaker neighbour on each side: the longest wave that can be
/// found is one wave over the travel (line 2). A longer wave has the shape of a position force.
constexpr double kFirstLine = 1;
/// Number of lines whose responses are filtered together.
constexpr std::size_t kGroup = 8;
/// Subdivisions between two lines, so that the phase of the wave fits over the whole travel.
constexpr std::size_t kRefinement = 16;
/// Cosine and sine.
constexpr Index kOfWave = 2;

struct Wave {
  double per_length = 0, power = 0;
  Vector2d amplitude = Vector2d::Zero();  ///< of cosine and sine
};

/// Forces of the quantities of a drive that a rig file states inaccurately: offset, Coulomb friction, viscous
/// friction, gain. Each changes with the direction or the speed, and therefore from place to place like a
/// long wave. A wrong gain causes a force in proportion to the measured acceleration. The command is not
/// used: the command of a controller that works against the wave contains the wave. @return responses by
/// piece
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

/// Equally spaced lines of the spectrum.
struct Lines {
  double first = 0, spacing = 0;  ///< 1 / length
  std::size_t count = 0;
};

/// Cosines and sines of the lines along a piece.
MatrixXd waves_along(const Pieces& drive, const Piece& piece, WaveOf of, const Lines& lines) {
  const std::vector<double>& rate = (*drive.runs)[piece.run].motion[drive.output].rate;
  MatrixXd waves(static_cast<Index>(piece.rows), kOfWave * static_cast<Index>(lines.count));
  for (std::size_t k = 0; k < piece.rows; ++k) {
    const double middle = 0.5 * (piece.position[k] + piece.position[std::min(k + 1, piece.rows - 1)]);
    const double turn = 2 * std::numbers::pi * middle;
    const double unit = of == WaveOf::friction ? std::copysign(1.0, rate[piece.first + k]) : 1.0;
    std::complex<double> wave = std::polar(1.0, turn * lines.first);
    const std::complex<double> next = std::polar(1.0, turn * lines.spacing);
    for (Index i = 0; i < waves.cols(); i += kOfWave, wave *= next) {
      waves(static_cast<Index>(k), i) = unit * wave.real();
      waves(static_cast<Index>(k), i + 1) = unit * wave.imag();
    }
  }
  return waves;
}

/// The wave of each line, fitted together with the known forces: power is the decrease of the loss beyond
/// that by the known forces alone.
std::vector<Wave> waves_of(const Pieces& drive, const std::vector<MatrixXd>& known, WaveOf of,
                           const Lines& lines) {
  const Index of_known = known[0].cols(), of_waves = kOfWave * static_cast<Index>(lines.count);
  NormalEquations all{of_known + of_waves};
  for (std::size_t i = 0; i < drive.all.size(); ++i) {
    const Piece& piece = drive.all[i];
    MatrixXd both(static_cast<Index>(piece.rows), of_known + of_waves);
    both << known[i], response_to(drive, piece, waves_along(drive, piece, of, lines));
    all += normal_equations(piece, both);
  }
  std::vector<Wave> waves;
  for (std::size_t line = 0; line < lines.count; ++line) {
    std::vector<Index> own(static_cast<std::size_t>(of_known + kOfWave));
    std::iota(own.begin(), own.end(), 0);
    for (Index i = 0; i < kOfWave; ++i)
      own[static_cast<std::size_t>(of_known + i)] = of_known + kOfWave * static_cast<Index>(line) + i;
    NormalEquations of_line{of_known + kOfWave};
    of_line.score = all.score(own);
    of_line.hessian = all.hessian(own, own);
    const NormalEquations wave = beside_first(of_line, of_known);
    const Vector2d amplitude = wave_amplitude(wave);
    waves.push_back(
        {lines.first + static_cast<double>(line) * lines.spacing, wave.score.dot(amplitude), amplitude});
  }
  return waves;
}

/// waves_of() on all processors.
std::vector<Wave> waves_in_groups(const Pieces& drive, const std::vector<MatrixXd>& known, WaveOf of,
                                  const Lines& lines) {
  std::vector<std::vector<Wave>> groups((lines.count + kGroup - 1) / kGroup);
  parallel_for(groups.size(), [&](std::size_t i) {
    const std::size_t first = i * kGroup;
    groups[i] = waves_of(drive, known, of,
                         {lines.first + static_cast<double>(first) * lines.spacing, lines.spacing,
                          std::min(kGroup, lines.count - first)});
  });
  std::vector<Wave> all;
  for (const std::vector<Wave>& group : groups) all.insert(all.end(), group.begin(), group.end());
  return all;
}

/// The strongest wave between the neighbours of `peak`.
Wave refined(const Pieces& drive, const std::vector<MatrixXd>& known, WaveOf of, const Wave& peak,
             double spacing) {
  const double finer = spacing / kRefinement;
  const std::vector<Wave> around =
      waves_in_groups(drive, known, of, {peak.per_length - spacing + finer, finer, 2 * kRefinement - 1});
  return *std::max_element(around.begin(), around.end(),
                           [](const Wave& a, const Wave& b) { return a.power < b.power; });
}

}  // namespace

std::vector<PositionWave> strongest_waves(const Pieces& drive, std::size_t count, WaveOf of) {
  const double travel = travel_of(*drive.runs, drive.output).width();
  if (drive.all.empty() || !(travel > 0)) return {};
  const double spacing = kLineSpacing / travel;
  const std::vector<MatrixXd> known = responses_of_known_forces(drive);
  const std::vector<Wave> lines =
      waves_in_groups(drive, known, of, {kFirstLine * spacing, spacing, kSpectrumLines});
  std::vector<std::size_t> peaks;
  for (std::size_t line = 1; line + 1 < kSpectrumLines; ++line)
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
