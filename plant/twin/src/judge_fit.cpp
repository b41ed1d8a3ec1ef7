#include <algorithm>
#include <cmath>

#include "crane/twin/judge.hpp"

namespace crane::twin {
namespace {

constexpr double kFitFreedom = 3;     // degrees of freedom of a block in the comparison of causes
constexpr double kUnexplained = 0.5;  // smallest explained share of the energy; below it the cause is unknown
constexpr double kOutside = 3;        // mean square of the residual / that of the worst learnt block

std::string label(const Hypothesis& h) { return h.axis.empty() ? h.cause : h.cause + " (" + h.axis + ")"; }

constexpr double kNearLow = 0.4, kNearHigh = 1.8;  // range of Hypothesis::only_near, in references

}  // namespace

/// Blocks of the deviation without the first one, in which the change occurred.
std::span<const Block> Judge::fitted_blocks() const {
  const std::size_t count = std::min(deviation_blocks_, recent_.size());
  return std::span{recent_}.last(count > 1 ? count - 1 : count);
}

/// Fits of all causes, the best first. After a cause was named, only the fit of this cause.
std::vector<Judge::Fit> Judge::fits() const {
  std::vector<Fit> list;
  for (std::size_t c = 0; c < hypotheses_.size(); ++c) {
    if (named_hypothesis_ && c != *named_hypothesis_) continue;
    const Weighed sum = weighed(fitted_blocks(), c);
    if (!(sum.information > 0)) continue;
    const double amount = sum.score / sum.information;
    const bool near = amount > kNearLow && amount < kNearHigh;
    if (named_hypothesis_ || near || !hypotheses_[c].only_near)
      list.push_back({c, amount * sum.score, amount, sum.information});
  }
  std::sort(list.begin(), list.end(), [](const Fit& a, const Fit& b) { return a.gain > b.gain; });
  return list;
}

Finding Judge::best_fit() const {
  PerColumn energy{};
  double in_control = 0, all = 0;
  for (const Block& block : fitted_blocks()) {
    in_control += block.ticks * static_cast<double>(kColumns);
    for (std::size_t i = 0; i < kColumns; ++i) energy[i] += block.energy[i] / variance_[i];
  }
  Finding found;
  for (std::size_t i = 0; i < kColumns; ++i) {
    all += energy[i];
    if (energy[i] > energy[found.column]) found.column = i;
  }
  const std::vector<Fit> list = fits();
  const bool outside = all > kOutside * in_control && !named_hypothesis_;
  if (list.empty() || (outside && list.front().gain < kUnexplained * all)) {
    found.cause = kUnknown;
    found.remedy = cause_kind(kUnknown).remedy;
    return found;
  }
  describe(list, all, std::max(1.0, in_control), found);
  return found;
}

/// @param all         energy of the residual
/// @param in_control  energy of the residual without a deviation
void Judge::describe(const std::vector<Fit>& list, double all, double in_control, Finding& found) const {
  const Fit& best = list.front();
  const Hypothesis& h = hypotheses_[best.hypothesis];
  const auto left = [&](double gain) { return std::max(all - gain, in_control); };
  const double noise = left(best.gain) / in_control * inflation_[best.hypothesis];
  found.cause = h.cause, found.axis = h.axis, found.unit = h.unit, found.remedy = h.remedy;
  found.hypothesis = best.hypothesis;
  found.size = best.amount * h.reference;
  found.size_std = std::sqrt(noise / best.information) * std::abs(h.reference);
  found.explained = best.gain / all;
  const auto rival = std::find_if(list.begin(), list.end(), [&](const Fit& fit) {
    return label(hypotheses_[fit.hypothesis]) != label(h);
  });
  if (rival == list.end()) {
    found.log_likelihood_ratio = kCertainLogRatio;
    return;
  }
  const auto blocks = static_cast<double>(fitted_blocks().size());
  found.log_likelihood_ratio = 0.5 * kFitFreedom * blocks * std::log(left(rival->gain) / left(best.gain));
  if (found.log_likelihood_ratio < kCertainLogRatio) found.rival = label(hypotheses_[rival->hypothesis]);
}

}  // namespace crane::twin
