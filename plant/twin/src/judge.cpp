#include "crane/twin/judge.hpp"

#include <algorithm>
#include <cmath>

namespace crane::twin {
namespace {

constexpr std::size_t kRemembered_blocks = 120;
constexpr double kClip = 0.4;         // largest increment / threshold: an alarm needs at least three blocks
constexpr double kVarianceRatio = 9;  // variance / learnt variance that the energy test detects
constexpr double kEnergyFreedom = 4;  // degrees of freedom of the coloured residual of a block
constexpr double kNamedShare = 0.8;   // explained share of the energy for naming a cause early
constexpr std::size_t kFewestToName = 5;
constexpr int kLongestDoubt_blocks = 16;
constexpr double kReturn = 7;  // log likelihood ratio that ends a deviation: 1000 to 1
constexpr int kQuiet_blocks = 8;

double limited(double value, double limit) { return std::clamp(value, -limit, limit); }

}  // namespace

Judge::Judge(std::vector<Hypothesis> hypotheses, const Design& design, const PerColumn& floor,
             int block_ticks)
    : hypotheses_(std::move(hypotheses)),
      design_(design),
      // Residuals are correlated within a horizon: a block is one observation, not one per tick.
      inflation_(hypotheses_.size(), block_ticks),
      // The mean time to a false alarm of a CUSUM of log likelihood ratios is at least e^threshold blocks.
      threshold_(std::log(design.false_alarm_s / design.block_s *
                          static_cast<double>(2 * hypotheses_.size() + kColumns))),
      up_(hypotheses_.size()),
      down_(hypotheses_.size()) {
  for (std::size_t i = 0; i < kColumns; ++i) variance_[i] = floor[i] * floor[i];
}

double Judge::learnt_share() const { return std::min(1.0, learnt_s_ / design_.learn_s); }

double Judge::evidence() const {
  double largest = 0;
  for (std::size_t c = 0; c < up_.size(); ++c) largest = std::max({largest, up_[c].value, down_[c].value});
  for (const Cusum& cusum : energy_) largest = std::max(largest, cusum.value);
  return largest / threshold_;
}

void Judge::add(const Block& block) {
  if (phase_ != Phase::learning) {
    judge(block);
    return;
  }
  if (!block.moving()) return;
  learnt_from_.push_back(block);
  learnt_s_ += design_.block_s;
  if (learnt_s_ < design_.learn_s) return;
  learn();
  phase_ = Phase::watching;
  // The mean was not learnt: a deviation that exists from the start must raise an alarm.
  for (const Block& earlier : learnt_from_) judge(earlier);
  learnt_from_.clear();
}

void Judge::judge(const Block& block) {
  recent_.push_back(block);
  if (recent_.size() > kRemembered_blocks) recent_.erase(recent_.begin());
  if (phase_ == Phase::deviates) {
    ++deviation_blocks_;
    if (!named_ || named_hypothesis_) name_cause();
    if (named_) look_for_return(block);
    return;
  }
  const double clip = kClip * threshold_;
  for (std::size_t c = 0; c < hypotheses_.size(); ++c) {
    const Weighed sum = weighed(block, c);
    up_[c].add(limited((sum.score - 0.5 * sum.information) / inflation_[c], clip));
    down_[c].add(limited((-sum.score - 0.5 * sum.information) / inflation_[c], clip));
  }
  if (block.moving())
    for (std::size_t i = 0; i < kColumns; ++i)
      energy_[i].add(limited(
          0.5 * kEnergyFreedom * (excess(block, i) * (1 - 1 / kVarianceRatio) - std::log(kVarianceRatio)),
          clip));
  if (evidence() >= 1) begin_deviation();
}

void Judge::begin_deviation() {
  phase_ = Phase::deviates;
  named_ = is_step_ = false;
  blocks_of_doubt_ = quiet_blocks_ = 0;
  return_evidence_ = 0;
  named_hypothesis_.reset();
  deviation_blocks_ = 1;
  double strongest = 0;
  const auto consider = [&](const Cusum& cusum) {
    if (cusum.value <= strongest) return;
    strongest = cusum.value;
    deviation_blocks_ = cusum.blocks;
  };
  for (std::size_t c = 0; c < hypotheses_.size(); ++c) consider(up_[c]), consider(down_[c]);
  for (const Cusum& cusum : energy_) consider(cusum);
  name_cause();
}

void Judge::name_cause() {
  Finding fit = best_fit();
  if (named_) {  // a named cause does not change; its size is updated
    finding_->size = fit.size, finding_->size_std = fit.size_std;
    return;
  }
  if (!recent_.empty() && recent_.back().moving()) ++blocks_of_doubt_;
  const bool certain = fit.explained >= kNamedShare && fit.log_likelihood_ratio >= kCertainLogRatio &&
                       fitted_blocks().size() >= kFewestToName;
  finding_ = std::move(fit);
  if (!certain && blocks_of_doubt_ < kLongestDoubt_blocks) return;
  named_ = true;
  named_hypothesis_ = finding_->hypothesis;
}

void Judge::found(const Finding& step) {
  if (phase_ == Phase::learning) return;
  const bool again =
      phase_ == Phase::deviates && is_step_ && finding_->cause == step.cause && finding_->axis == step.axis;
  if (phase_ == Phase::deviates && !again) return;  // one deviation at a time
  const double before = again ? finding_->size : 0;
  phase_ = Phase::deviates;
  finding_ = step;
  finding_->size += before;
  named_ = is_step_ = true;
  named_hypothesis_.reset();
  quiet_blocks_ = 0;
}

void Judge::look_for_return(const Block& block) {
  if (named_hypothesis_) {
    const std::size_t c = *named_hypothesis_;
    const Weighed sum = weighed(block, c);
    const double amount = finding_->size / hypotheses_[c].reference;
    const double agrees = (-amount * sum.score + 0.5 * amount * amount * sum.information) / inflation_[c];
    return_evidence_ = std::max(0.0, return_evidence_ + limited(agrees, kClip * kReturn));
    if (return_evidence_ >= kReturn) agree();
    return;
  }
  if (!is_step_ && !block.moving()) return;
  bool inside = true;
  for (std::size_t i = 0; i < kColumns; ++i) inside = inside && excess(block, i) < 1.5;
  quiet_blocks_ = inside ? quiet_blocks_ + 1 : 0;
  if (quiet_blocks_ >= kQuiet_blocks) agree();
}

void Judge::agree() {
  phase_ = Phase::watching;
  finding_.reset();
  named_hypothesis_.reset();
  named_ = is_step_ = false;
  recent_.clear();
  deviation_blocks_ = 0;
  std::fill(up_.begin(), up_.end(), Cusum{});
  std::fill(down_.begin(), down_.end(), Cusum{});
  energy_.fill({});
}

}  // namespace crane::twin
