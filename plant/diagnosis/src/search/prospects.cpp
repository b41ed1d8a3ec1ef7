#include "search/prospects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "search/compare.hpp"
#include "search/parts.hpp"

namespace crane::diagnosis {
namespace {

/// Largest number of hypotheses of one size that are refitted: by likelihood, by error.
constexpr std::size_t kLikeliest = 2, kSmallestError = 2;
/// Lower bound of predicted / true share of the loss. The noise model describes the rest of the effect as a
/// disturbance.
constexpr double kLeastPredicted = 0.02;

bool may_exceed(const Fitted& first_fit, const Fitted& best) {
  return first_fit.effects.size() <= best.effects.size() || first_fit.misfit < best.misfit;
}

}  // namespace

double distance_from(const Fitted& best, const Fitted& fitted) {
  return std::max(0.0, sum(fitted.deviance) - sum(best.deviance));
}

double reachable_decrease(const Score& score, const Candidate& candidate, const Fitted& given) {
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  if (candidate.rough || candidate.ringing_starts_at) return kUnbounded;
  const double loss =
      (candidate.drive ? given.train.drive_loss : 0) + (candidate.load ? given.train.load_loss : 0);
  const double share = std::max(0.0, score.share) / kLeastPredicted;
  return share < 1 ? -loss * std::log1p(-share) : kUnbounded;
}

std::vector<Fitted> worth_a_refit(std::vector<Fitted> first_fits, const Fitted& base, const Fitted& best) {
  std::ranges::sort(first_fits, {}, &Fitted::misfit);
  std::vector<Fitted> chosen;
  for (Fitted& fitted : first_fits)
    if (find(chosen, fitted.effects) == nullptr && may_exceed(fitted, best))
      chosen.push_back(std::move(fitted));
  if (chosen.size() > kLikeliest)
    std::sort(chosen.begin() + kLikeliest, chosen.end(), [&](const Fitted& a, const Fitted& b) {
      return share_of_error_in_windows(a, base) > share_of_error_in_windows(b, base);
    });
  chosen.resize(std::min(chosen.size(), kLikeliest + kSmallestError));
  return chosen;
}

}  // namespace crane::diagnosis
