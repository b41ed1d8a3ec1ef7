#include "force/force_lines.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <sstream>

#include "force/cross_validation.hpp"
#include "parallel.hpp"
#include "robust.hpp"
#include "rules.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// Frequencies of the lines. Spacing: half the resolution 1 / 40 s.
constexpr double kLowest_hz = 0.1, kHighest_hz = 4, kSpacing_hz = 0.0125;

/// A force of one frequency: cosine and sine on each piece. Each run has its own phase.
struct Line {
  double hz = 0;
  std::vector<std::optional<NormalEquations>> pieces;  ///< nothing: the run is omitted
};

double turn_per_row(const Run& run, double hz) { return 2 * std::numbers::pi * hz * run.period_s; }

/// Amplitude of the command at `hz` if its Fourier components have similar phases in all pieces of the run
/// (Rayleigh test), else 0. V
double commanded_v(const Pieces& pieces, std::size_t run_index, double hz) {
  const double most =
      -std::log(rules::kCommandLevel.value);  // of random phases: exponentially distributed, mean 1
  const Run& run = (*pieces.runs)[run_index].run;
  const std::size_t axis = pieces.output == kSlewAngle ? plant::kSlew : plant::kTrolley;
  std::complex<double> sum = 0;
  double squares = 0, rows = 0;
  for (const Piece& piece : pieces.all) {
    if (piece.run != run_index) continue;
    std::complex<double> component = 0;
    for (std::size_t k = piece.first; k < piece.first + piece.rows; ++k)
      component += run.command_v[k][axis] * std::polar(1.0, -turn_per_row(run, hz) * static_cast<double>(k));
    sum += component;
    squares += std::norm(component);
    rows += static_cast<double>(piece.rows);
  }
  return std::norm(sum) > most * squares ? 2 * std::abs(sum) / rows : 0;
}

/// Omits the runs whose force can be a function of a periodic motion, for example friction whose form differs
/// from that of the model: the command contains the line, and the force is below rules::kLeastOfCommand times
/// the command.
void omit_commanded(const Pieces& pieces, double volt_acceleration, Line& line) {
  std::map<std::size_t, NormalEquations> by_run;
  for (std::size_t i = 0; i < line.pieces.size(); ++i)
    by_run.try_emplace(pieces.all[i].run, NormalEquations{2}).first->second += *line.pieces[i];
  for (const auto& [run, sums] : by_run) {
    const double least = rules::kLeastOfCommand * volt_acceleration * commanded_v(pieces, run, line.hz);
    if (wave_amplitude(sums).norm() >= least) continue;
    for (std::size_t i = 0; i < line.pieces.size(); ++i)
      if (pieces.all[i].run == run) line.pieces[i].reset();
  }
}

Line line_at(const Pieces& pieces, double hz) {
  Line line{hz, {}};
  for (const Piece& piece : pieces.all) {
    const double turn = turn_per_row((*pieces.runs)[piece.run].run, hz);
    MatrixXd waves(static_cast<Index>(piece.rows), 2);
    for (Index k = 0; k < waves.rows(); ++k) {
      const double phase = turn * static_cast<double>(static_cast<Index>(piece.first) + k);
      waves(k, 0) = std::cos(phase), waves(k, 1) = std::sin(phase);
    }
    line.pieces.emplace_back(normal_equations(pieces, piece, std::move(waves)));
  }
  return line;
}

/// Sums over the pieces of each run, inside or outside a fold.
using ByRun = std::map<std::size_t, NormalEquations>;

ByRun summed_by_run(const Pieces& pieces, const Line& line, const VectorXd& signs, std::size_t fold,
                    bool inside) {
  ByRun sums;
  for (std::size_t i = 0; i < line.pieces.size(); ++i) {
    if (!line.pieces[i] || (i % kFolds == fold) != inside) continue;
    auto [of_run, fresh] = sums.try_emplace(pieces.all[i].run, NormalEquations{2});
    of_run->second.score += signs[static_cast<Index>(i)] * line.pieces[i]->score;
    of_run->second.hessian += line.pieces[i]->hessian;
  }
  return sums;
}

/// The line with the largest gain outside a fold; fold kFolds: in all pieces. Null: no line has a gain.
const Line* strongest_outside(std::size_t fold, const Pieces& pieces, const std::vector<Line>& lines,
                              const VectorXd& signs) {
  const Line* strongest = nullptr;
  double most = 0;
  for (const Line& line : lines) {
    double gain = 0;
    for (const auto& [run, sums] : summed_by_run(pieces, line, signs, fold, false))
      gain += sums.score.dot(wave_amplitude(sums));
    if (gain > most) most = gain, strongest = &line;
  }
  return strongest;
}

/// Gain of a line of which the pieces outside each fold determine frequency and amplitude.
double line_gain(const Pieces& pieces, const std::vector<Line>& lines, const VectorXd& signs) {
  double gain = 0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const Line* line = strongest_outside(fold, pieces, lines, signs);
    if (line == nullptr) continue;
    const ByRun others = summed_by_run(pieces, *line, signs, fold, false);
    for (const auto& [run, own] : summed_by_run(pieces, *line, signs, fold, true)) {
      const auto known = others.find(run);
      if (known == others.end()) continue;
      const Vector2d amplitude = wave_amplitude(known->second);
      gain += own.gain(amplitude);
    }
  }
  return gain;
}

/// Largest gain under random signs of the pieces.
double largest_by_sign_flips(const Pieces& pieces, const std::vector<Line>& lines, std::uint64_t seed) {
  const std::vector<VectorXd> signs = random_signs(static_cast<Index>(pieces.all.size()), seed);
  std::vector<double> gains(signs.size());
  parallel_for(signs.size(), [&](std::size_t i) { gains[i] = line_gain(pieces, lines, signs[i]); });
  return *std::max_element(gains.begin(), gains.end());
}

}  // namespace

std::optional<Unexplained> find_force_line(const Pieces& pieces, std::uint64_t seed,
                                           double volt_acceleration) {
  if (pieces.all.empty()) return std::nullopt;
  const double loss = pieces.loss(), least = pieces.of_load() ? rules::kLineOfLoad : rules::kLineOfDrives;
  std::vector<Line> lines(static_cast<std::size_t>((kHighest_hz - kLowest_hz) / kSpacing_hz));
  parallel_for(lines.size(), [&](std::size_t i) {
    lines[i] = line_at(pieces, kLowest_hz + kSpacing_hz * static_cast<double>(i));
    if (volt_acceleration > 0) omit_commanded(pieces, volt_acceleration, lines[i]);
  });
  const VectorXd as_measured = VectorXd::Ones(static_cast<Index>(pieces.all.size()));
  const double gain = line_gain(pieces, lines, as_measured);
  if (gain < least * loss || gain <= largest_by_sign_flips(pieces, lines, seed)) return std::nullopt;
  const double hz = strongest_outside(kFolds, pieces, lines, as_measured)->hz;
  std::ostringstream name;
  name.precision(3);
  name << kOutputNames[pieces.output] << ": time, " << hz << " Hz";
  Unexplained line{name.str(), GoesWith::frequency, pieces.output, gain, gain / loss};
  line.hz = hz;
  return line;
}

}  // namespace crane::diagnosis
