#include "force/swing_patterns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "force/bins.hpp"
#include "force/cross_validation.hpp"
#include "force/pendulum_response.hpp"
#include "force/swing_variables.hpp"
#include "parallel.hpp"
#include "replay/travel.hpp"
#include "robust.hpp"
#include "rules.hpp"
#include "shooting/pieces.hpp"
#include "study/study.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Values of the bins, row x bin.
MatrixXd shapes_in(std::size_t window, std::size_t rows, const SwingVariable& variable, const Extent& range) {
  MatrixXd shapes(static_cast<Index>(rows), static_cast<Index>(variable.bins));
  for (Index k = 0; k < shapes.rows(); ++k) {
    const auto row = static_cast<std::size_t>(k);
    const double share = (variable.value[window][row] - range.low) / range.width();
    shapes.row(k) = variable.factor[window][row] * triangular_bins(share, variable.bins);
  }
  return shapes;
}

/// Free motion of the load, which the start of a window explains.
MatrixXd free_motion(Index rows, const WindowMotion& motion) {
  MatrixXd free(rows, 2);
  for (Index k = 0; k < rows; ++k) {
    const double phase = motion.natural_radps * motion.period_s * static_cast<double>(k);
    free(k, 0) = std::cos(phase), free(k, 1) = std::sin(phase);
  }
  return free;
}

/// Free motion, and changes of a simulated swing by errors within the accuracy of the rig file: of the scale
/// of the swing or of the support, of the cable length and of the delay.
MatrixXd inaccurate_motion(const VectorXd& swing, const WindowMotion& motion) {
  MatrixXd of_length = swing;
  replace_by_pendulum_response(of_length, motion.natural_radps, motion.period_s);
  VectorXd of_delay = VectorXd::Zero(swing.size());
  if (const Index inner = swing.size() - 2; inner > 0)
    of_delay.segment(1, inner) = swing.tail(inner) - swing.head(inner);
  MatrixXd all(swing.size(), 5);
  all << free_motion(swing.size(), motion), swing, of_length * (motion.natural_radps * motion.natural_radps),
      of_delay;
  return all;
}

/// The part of `change` that no combination of the columns explains.
VectorXd beside(const MatrixXd& columns, const VectorXd& change) {
  return change - columns * columns.colPivHouseholderQr().solve(change);
}

class PatternTests {
 public:
  PatternTests(const Problem& problem, const Fits& fits, std::size_t output)
      : problem_(problem), fits_(fits), output_(output), pieces_(pieces_of(problem, fits, output)) {}

  [[nodiscard]] const Pieces& pieces() const { return pieces_; }
  [[nodiscard]] Index block_count() const {
    Index count = 0;
    for (std::size_t w = 0; w < pieces_.all.size(); ++w) count += blocks_in(w);
    return count;
  }

  struct Tested {
    SwingVariable variable;
    Extent range;
    std::vector<NormalEquations> blocks;
    Eigen::LDLT<MatrixXd> curvature;            ///< of all blocks
    std::vector<Eigen::LDLT<MatrixXd>> others;  ///< by fold: curvature of all other folds
  };

  [[nodiscard]] Tested tested(SwingVariable variable) const {
    Tested test{std::move(variable), {}, {}, {}, {}};
    for (const std::vector<double>& run : test.variable.value)
      for (const double value : run) test.range.take(value);
    NormalEquations all{static_cast<Index>(test.variable.bins)};
    for (std::size_t w = 0; w < pieces_.all.size(); ++w) add_blocks(test, w, all);
    const double ridge = ridge_of(all);
    for (std::size_t fold = 0; fold < kFolds; ++fold) {
      NormalEquations others = all;
      for (std::size_t b = 0; b < test.blocks.size(); ++b)
        if (fold_of(b, test) == fold) others -= test.blocks[b];
      others.hessian.diagonal().array() += ridge;
      test.others.emplace_back(others.hessian);
    }
    all.hessian.diagonal().array() += ridge;
    test.curvature.compute(all.hessian);
    return test;
  }

  /// Cross-validated decrease of the loss with signs of the blocks.
  [[nodiscard]] double gain(const Tested& test, const VectorXd& signs) const {
    const auto bins = static_cast<Index>(test.variable.bins);
    std::array<double, kFolds> gains{};
    for (std::size_t fold = 0; fold < kFolds; ++fold) {
      NormalEquations own{bins};
      VectorXd score = VectorXd::Zero(bins);
      for (std::size_t b = 0; b < test.blocks.size(); ++b) {
        const double sign = signs[static_cast<Index>(b)];
        if (fold_of(b, test) != fold) {
          score += sign * test.blocks[b].score;
          continue;
        }
        own.score += sign * test.blocks[b].score;
        own.hessian += test.blocks[b].hessian;
      }
      gains[fold] = own.gain(test.others[fold].solve(score));
    }
    return gain_of_folds(gains);
  }

  [[nodiscard]] double rms(const Tested& test) const {
    const VectorXd amplitudes = test.curvature.solve(score_of(test, VectorXd::Ones(block_count())));
    double squares = 0, count = 0;
    for (std::size_t w = 0; w < pieces_.all.size(); ++w) {
      const auto rows = static_cast<Index>(problem_.windows()[w].rows);
      const WindowMotion& motion = problem_.motion(output_, w);
      const VectorXd swing = fits_[w].simulated.segment(static_cast<Index>(output_) * rows, rows);
      const MatrixXd permitted =
          test.variable.of_own_swing ? inaccurate_motion(swing, motion) : free_motion(rows, motion);
      squares += beside(permitted, response(test, w) * amplitudes).squaredNorm();
      count += static_cast<double>(pieces_.all[w].rows);
    }
    return std::sqrt(squares / count);
  }

 private:
  /// Folds are consecutive blocks: a pattern must hold in parts of the data that are apart in time.
  [[nodiscard]] static std::size_t fold_of(std::size_t block, const Tested& test) {
    return block * kFolds / test.blocks.size();
  }

  [[nodiscard]] static VectorXd score_of(const Tested& test, const VectorXd& signs) {
    VectorXd score = VectorXd::Zero(static_cast<Index>(test.variable.bins));
    for (std::size_t b = 0; b < test.blocks.size(); ++b)
      score += signs[static_cast<Index>(b)] * test.blocks[b].score;
    return score;
  }

  /// Appends the normal equations of the blocks of a window and adds them to `all`. The whitened residuals of
  /// different rows are independent.
  void add_blocks(Tested& test, std::size_t window, NormalEquations& all) const {
    const Piece& piece = pieces_.all[window];
    const MatrixXd whitened = response_to(pieces_, piece, response(test, window));
    const VectorXd weights = weights_of(piece.residual);
    const auto rows = static_cast<Index>(piece.rows);
    const Index blocks = blocks_in(window);
    for (Index block = 0; block < blocks; ++block) {
      const Index first = block * rows / blocks, count = (block + 1) * rows / blocks - first;
      const auto part = whitened.middleRows(first, count);
      NormalEquations equations;
      equations.score =
          part.transpose() * weights.segment(first, count).cwiseProduct(piece.residual.segment(first, count));
      equations.hessian = part.transpose() * weights.segment(first, count).asDiagonal() * part;
      all += equations;
      test.blocks.push_back(std::move(equations));
    }
  }

  [[nodiscard]] Index blocks_in(std::size_t window) const {
    const double duration_s =
        static_cast<double>(pieces_.all[window].rows) * problem_.motion(output_, window).period_s;
    return std::max<Index>(1, std::lround(duration_s / kBlock_s));
  }

  /// Change of the swing, row x bin, rad.
  [[nodiscard]] MatrixXd response(const Tested& test, std::size_t window) const {
    MatrixXd shapes = shapes_in(window, problem_.windows()[window].rows, test.variable, test.range);
    const WindowMotion& motion = problem_.motion(output_, window);
    if (!test.variable.of_sensor) replace_by_pendulum_response(shapes, motion.natural_radps, motion.period_s);
    return shapes;
  }

  const Problem& problem_;
  const Fits& fits_;
  std::size_t output_;
  Pieces pieces_;
};

}  // namespace

std::vector<SwingPattern> find_swing_patterns(const Problem& problem, const Fits& fits, std::size_t output,
                                              std::uint64_t seed) {
  std::vector<SwingPattern> found;
  const PatternTests patterns(problem, fits, output);
  const Index blocks = patterns.block_count();
  const double loss = patterns.pieces().loss();
  std::vector<SwingVariable> variables = swing_variables_of(problem, fits, output);
  std::vector<std::optional<PatternTests::Tested>> tests(variables.size());
  parallel_for(tests.size(), [&](std::size_t i) { tests[i] = patterns.tested(std::move(variables[i])); });

  const std::vector<VectorXd> flips = random_signs(blocks, seed);
  std::vector<double> largest(flips.size(), 0.0);
  parallel_for(flips.size(), [&](std::size_t i) {
    for (const auto& test : tests) largest[i] = std::max(largest[i], patterns.gain(*test, flips[i]));
  });
  const double by_luck = *std::ranges::max_element(largest);

  for (const auto& test : tests) {
    const double gain = patterns.gain(*test, VectorXd::Ones(blocks));
    if (gain <= std::max(by_luck, double{rules::kPatternLuck})) continue;
    found.push_back({test->variable.name, problem.outputs()[output], gain / loss, patterns.rms(*test),
                     test->variable.of_own_swing});
  }
  std::ranges::sort(found,
                    [](const SwingPattern& a, const SwingPattern& b) { return a.fraction > b.fraction; });
  return found;
}

}  // namespace crane::diagnosis
