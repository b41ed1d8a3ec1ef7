#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>

#include "force/normal_equations.hpp"
#include "force/swing_patterns.hpp"
#include "rules.hpp"
#include "shooting/pieces.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;

constexpr double kLowestBand_hz = 0.3, kHighestBand_hz = 4, kBandSpacing_hz = 0.1;

/// Fit of one wave per window, with a phase of its own.
struct Waves {
  double power = 0;  ///< P(f): decrease of the loss per amplitude, noise variances
  double loss = 0;   ///< decrease of the loss
  double squares_rad2 = 0;
};

Waves waves_at(const Pieces& pieces, double hz) {
  Waves waves;
  const auto count = static_cast<double>(pieces.all.size());
  for (const Piece& piece : pieces.all) {
    const double turn = 2 * std::numbers::pi * hz * (*pieces.runs)[piece.run].run.period_s;
    Eigen::MatrixXd wave(static_cast<Index>(piece.rows), 2);
    for (Index k = 0; k < wave.rows(); ++k) {
      const double phase = turn * static_cast<double>(k);
      wave(k, 0) = std::cos(phase), wave(k, 1) = std::sin(phase);
    }
    const NormalEquations equations = normal_equations(pieces, piece, std::move(wave));
    const Eigen::Vector2d amplitude = wave_amplitude(equations);
    const double gain = equations.score.dot(amplitude);
    waves.loss += gain;
    waves.power += gain / (2 * count);
    waves.squares_rad2 += amplitude.squaredNorm() / (2 * count);
  }
  return waves;
}

/// p value of the ratio of two mean gains of `amplitudes` amplitudes each: tail of the F distribution.
double p_value_of_ratio(double ratio, double amplitudes) {
  return boost::math::ibeta(amplitudes / 2, amplitudes / 2, 1 / (1 + ratio));
}

}  // namespace

std::optional<SwingPattern> find_narrow_band(const Problem& problem, const Fits& fits, std::size_t output) {
  const Pieces pieces = pieces_of(problem, fits, output);
  if (pieces.all.empty()) return std::nullopt;
  double longest_period_s = 0, seconds = 0;
  for (const Piece& piece : pieces.all) {
    const double period_s = (*pieces.runs)[piece.run].run.period_s;
    longest_period_s = std::max(longest_period_s, period_s);
    seconds += period_s * static_cast<double>(piece.rows);
  }
  // Twice the frequency must be sampled at least twice per period.
  const double highest_hz = std::min(kHighestBand_hz, 1 / (4 * longest_period_s));
  double ratio = 0, hz = 0;
  Waves strongest;
  for (double at_hz = kLowestBand_hz; at_hz < highest_hz; at_hz += kBandSpacing_hz) {
    const Waves waves = waves_at(pieces, at_hz);
    const double beside = std::max(waves_at(pieces, at_hz / 2).power, waves_at(pieces, 2 * at_hz).power);
    if (waves.power > ratio * beside) ratio = waves.power / beside, hz = at_hz, strongest = waves;
  }
  if (!(ratio > 1)) return std::nullopt;
  const auto windows = static_cast<double>(pieces.all.size());
  const double resolved = std::max(1.0, (highest_hz - kLowestBand_hz) * seconds / windows);
  if (p_value_of_ratio(ratio, 2 * windows) * resolved > rules::kSignificant) return std::nullopt;
  std::ostringstream name;
  name << kOutputNames[pieces.output] << ": force, " << std::setprecision(2) << hz << " Hz";
  const double beyond = 1 - 1 / ratio;
  return SwingPattern{name.str(), pieces.output, beyond * strongest.loss / pieces.loss(),
                      std::sqrt(beyond * strongest.squares_rad2)};
}

}  // namespace crane::diagnosis
