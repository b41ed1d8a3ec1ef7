#include "study/descent.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "study/free_values.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostRounds = 12;
/// Largest number of attempts for one group of values in a round, each with more damping than the attempt
/// before. kFewAttempts applies to the values of one effect alone, and while the loss exceeds `loss_to_beat`.
constexpr int kAttempts = 7, kFewAttempts = 3;
/// Damping: initial; smallest; factor after a step that decreases the loss; smallest after one that does not,
/// and its factor.
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-6, kLessDamping = 0.2, kFailedDamping = 1e-4,
                 kMoreDamping = 8;
/// The least gain of a round for the sum of squares: the larger of a number of noise variances and a share of
/// the sum.
constexpr double kLeastGainOfSquares = 3, kLeastShareOfSquares = 1e-4;
/// A descent ends before a step whose predicted decrease is less than this share of the least decrease of a
/// round.
constexpr double kWorthAStep = 0.3;
/// From this round on, a descent ends if kDecreaseMargin times the predicted decrease does not bring the loss
/// below `loss_to_beat`.
constexpr int kLeastRounds = 1;
constexpr double kDecreaseMargin = 4;
/// The slopes along effects are computed again only if the decrease of the loss by a step differs from the
/// predicted one by more than this share (gain ratio of a trust region: J. J. Moré, Lect. Notes Math. 630
/// (1978) 105).
constexpr double kAsPredicted = 0.25;

/// Predicted decrease of the loss by an undamped step without bounds.
double largest_predicted_decrease(const BlockScores& at) {
  return at.gradient().dot(solve(at.curvature, at.gradient()));
}

/// Predicted decrease of the loss by a step.
double predicted_decrease_of(const BlockScores& at, const VectorXd& step) {
  return step.allFinite() ? 2 * at.gradient().dot(step) - step.dot(at.curvature * step) : 0;
}

/// Groups of values that change together in a step: all values; then, if there are several effects, the
/// values of each effect alone, so that an effect with a discontinuous loss does not block the others.
/// @param alone  false: no effect alone
std::vector<std::vector<Index>> step_groups(const Effects& effects, bool alone) {
  std::vector<std::vector<Index>> groups(1);
  Index next = 0;
  for (const Effect& effect : effects) {
    std::vector<Index> own(effect.values.size());
    for (Index& k : own) k = next++;
    groups[0].insert(groups[0].end(), own.begin(), own.end());
    if (alone && effects.size() > 1) groups.push_back(std::move(own));
  }
  return groups;
}

/// Loss including the determinants of the starts.
double total_loss(const Evaluation& at, Loss loss) {
  if (loss == Loss::robust) return at.loss;
  double sum = 0;
  for (const Fits* fits : {&at.drive, &at.load})
    for (const WindowFit& fit : *fits) sum += fit.residual.squaredNorm() + fit.start_log_determinant;
  for (const VectorXd& residual : at.equation_error) sum += residual.squaredNorm();
  return sum;
}

/// Number of values of the leading effects, without those of the inaccuracies that follow.
std::size_t own_values(const Effects& effects, std::size_t inaccuracies) {
  std::size_t values = 0;
  for (std::size_t i = 0; i + inaccuracies < effects.size(); ++i) values += effects[i].values.size();
  return values;
}

class GaussNewton {
 public:
  GaussNewton(const WhitenedData& data, Fitted& best, const Descent& descent, Slopes& along)
      : data_(data), best_(best), descent_(descent), along_(along) {
    least_ = total_loss(best.train, descent.loss);
    enough_ = descent.loss == Loss::robust ? descent.least_gain
                                           : std::max(kLeastGainOfSquares, kLeastShareOfSquares * least_);
    if (descent.inaccuracies > 0) computed_at_ = simulation_of(best.train);
  }

  /// @return as descend()
  bool run() {
    for (int round = 0; round < kMostRounds; ++round) {
      const BlockScores scores = scores_here();
      if (round >= kLeastRounds && !can_beat(scores)) return false;
      bool as_predicted = true;
      if (gained_in_round(scores, as_predicted) < enough_) break;
      if (!as_predicted) forget_old_slopes();
    }
    return true;
  }

 private:
  BlockScores scores_here() {
    if (!whitened_) {
      along_ = data_.plain_slopes(best_.effects, best_.train, std::move(along_));
      whitened_ = data_.whitened(along_, best_.train);
    }
    return data_.scores(best_.train, *whitened_, descent_.loss);
  }

  /// Whether the loss may still fall below the loss to beat.
  [[nodiscard]] bool can_beat(const BlockScores& scores) const {
    if (!std::isfinite(descent_.loss_to_beat)) return true;
    const double decrease = largest_predicted_decrease(
        descent_.loss == Loss::robust ? scores : data_.scores(best_.train, *whitened_));
    return best_.train.loss - kDecreaseMargin * decrease <= descent_.loss_to_beat;
  }

  /// Steps all values together and, if that gains too little, the values of each effect alone.
  /// @param as_predicted  becomes false if the decrease of the loss by a step differs from the predicted one
  /// @return decrease of the loss
  double gained_in_round(const BlockScores& scores, bool& as_predicted) {
    const VectorXd gradient = scores.gradient();
    const FreeValues from = free_values_of(best_.effects);
    const auto groups = step_groups(best_.effects, descent_.inaccuracies == 0);
    const VectorXd whole = bounded_step(scores.curvature, gradient, from, 0, groups[0]);
    if (predicted_decrease_of(scores, whole) < kWorthAStep * enough_) return 0;
    double gained = 0;
    for (std::size_t group = 0; group < groups.size() && gained < enough_; ++group) {
      const int attempts = group == 0 && best_.train.loss <= descent_.loss_to_beat ? kAttempts : kFewAttempts;
      for (int attempt = 0; attempt < attempts; ++attempt) {
        const VectorXd step = bounded_step(scores.curvature, gradient, from, damping_, groups[group]);
        if (!step.allFinite() || step.norm() == 0) break;
        const double decrease = decrease_by(step), predicted = predicted_decrease_of(scores, step);
        as_predicted = as_predicted && std::abs(decrease - predicted) <= kAsPredicted * predicted;
        if (decrease > 0) {
          gained += decrease;
          damping_ = std::max(kLeastDamping, kLessDamping * damping_);
          break;
        }
        damping_ = kMoreDamping * std::max(damping_, kFailedDamping);
      }
      if (gained < enough_) damping_ = kFirstDamping;
    }
    return gained;
  }

  /// Takes the step if it decreases the loss. @return decrease of the loss by the step
  double decrease_by(const VectorXd& step) {
    Fitted tried;
    tried.effects = moved(best_.effects, step);
    tried.train = data_.evaluated(tried.effects, best_.train);
    const double now = total_loss(tried.train, descent_.loss), decrease = least_ - now;
    if (!(decrease > 0)) return decrease;
    least_ = now;
    best_.effects = std::move(tried.effects);
    best_.train = std::move(tried.train);
    return decrease;
  }

  /// Forgets the slopes along the effects, and those along the inaccuracies in the parts in which the
  /// simulation is unlike the one at which they were computed.
  void forget_old_slopes() {
    whitened_.reset();
    const std::size_t own = own_values(best_.effects, descent_.inaccuracies);
    along_.forget(0, own, {true, true});
    if (descent_.inaccuracies == 0) return;
    const ShowsIn unlike_now = unlike(data_.body(), best_.effects, best_.train, computed_at_);
    along_.forget(own, along_.size(), unlike_now);
    Simulation now = simulation_of(best_.train);
    if (unlike_now.drive) computed_at_.drive = std::move(now.drive);
    if (unlike_now.load) computed_at_.load = std::move(now.load);
  }

  const WhitenedData& data_;
  Fitted& best_;
  const Descent& descent_;
  Slopes& along_;
  double damping_ = kFirstDamping;
  double least_ = 0, enough_ = 0;   ///< present loss; least decrease of a round that is not the last
  std::optional<Slopes> whitened_;  ///< `along_`
  Simulation computed_at_;          ///< at which the slopes along the inaccuracies were computed
};

}  // namespace

bool descend(const WhitenedData& data, Fitted& best, const Descent& descent, Slopes& along) {
  return GaussNewton(data, best, descent, along).run();
}

}  // namespace crane::diagnosis
