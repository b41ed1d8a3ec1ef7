#include <algorithm>
#include <cmath>

#include "crane/twin/judge.hpp"

namespace crane::twin {
namespace {

constexpr double kPasses = 0.5;  // largest amount without an alarm, in references
// Explained share of the energy above which the effect of a cause is excluded from the scatter.
constexpr double kWrongFromTheStart = 0.5;

}  // namespace

Judge::Weighed Judge::weighed(const Block& block, std::size_t hypothesis) const {
  Weighed sum;
  for (std::size_t i = 0; i < kColumns; ++i) {
    sum.score += block.score[hypothesis][i] / variance_[i];
    sum.information += block.information[hypothesis][i] / variance_[i];
  }
  return sum;
}

Judge::Weighed Judge::weighed(std::span<const Block> blocks, std::size_t hypothesis) const {
  Weighed sum;
  for (const Block& block : blocks) {
    const Weighed one = weighed(block, hypothesis);
    sum.score += one.score, sum.information += one.information;
  }
  return sum;
}

double Judge::excess(const Block& block, std::size_t column) const {
  double passes = 0;  // largest energy of half a reference size of any cause
  for (const PerColumn& information : block.information)
    passes = std::max(passes, kPasses * kPasses * information[column]);
  return block.energy[column] / (passes + block.ticks * variance_[column]);
}

/// Learns the variance of the residuals after subtracting the effect of `amount` references of `hypothesis`.
void Judge::learn_variance(const PerColumn& floor, std::size_t hypothesis, double amount) {
  for (std::size_t i = 0; i < kColumns; ++i) {
    variance_[i] = floor[i];
    // The residual depends on the motion: the variance is that of the worst block.
    for (const Block& block : learnt_from_) {
      const double score = block.score[hypothesis][i], information = block.information[hypothesis][i];
      const double energy = block.energy[i] - 2 * amount * score + amount * amount * information;
      variance_[i] = std::max(variance_[i], energy / block.ticks);
    }
    band_[i] = 3 * std::sqrt(variance_[i]);
  }
}

/// Learns the scatter. A cause that explains most of the learnt residual is a deviation from the start; its
/// effect is excluded.
void Judge::learn() {
  const PerColumn floor = variance_;
  learn_variance(floor, 0, 0);
  double all = 0, most = 0, amount = 0;
  std::size_t cause = 0;
  for (const Block& block : learnt_from_)
    for (std::size_t i = 0; i < kColumns; ++i) all += block.energy[i] / variance_[i];
  for (std::size_t c = 0; c < hypotheses_.size(); ++c) {
    const Weighed sum = weighed(learnt_from_, c);
    if (!(sum.information > 0) || sum.score * sum.score / sum.information <= most) continue;
    most = sum.score * sum.score / sum.information;
    amount = sum.score / sum.information;
    cause = c;
  }
  if (most > kWrongFromTheStart * all && std::abs(amount) > kPasses) learn_variance(floor, cause, amount);
  learn_inflation();
}

void Judge::learn_inflation() {
  for (std::size_t c = 0; c < hypotheses_.size(); ++c) {
    const Weighed all = weighed(learnt_from_, c);
    if (!(all.information > 0)) continue;
    const double mean = all.score / all.information;
    double scatter = 0;
    for (const Block& block : learnt_from_) {
      const Weighed one = weighed(block, c);
      const double left = one.score - mean * one.information;
      scatter += left * left;
    }
    inflation_[c] = std::max(inflation_[c], scatter / all.information);
  }
}

}  // namespace crane::twin
