#include "search/elimination.hpp"

#include <algorithm>

#include "search/compare.hpp"
#include "search/intervals.hpp"
#include "search/parts.hpp"

namespace crane::diagnosis {

Fitted without_insignificant(Study& study, Hypotheses& found, std::uint64_t seed) {
  for (;;) {
    Fitted best = with_intervals(study, found.best, seed);
    if (best.effects.size() < 2) return best;
    const std::vector<double> p_values = wald_p_values(best);
    const auto least_certain = std::ranges::max_element(p_values);
    if (!insignificant(*least_certain, study.candidates().size())) return best;
    const Effects rest = without(best.effects, static_cast<std::size_t>(least_certain - p_values.begin()));
    if (const Fitted* part = find(found.all, rest)) {
      found.best = *part;
    } else {
      found.best = study.refit_with_own_noise(study.first_fit(rest, study.base_model()));
      keep(found.all, found.best);
      found.ranking.push_back(ranked_against(found.base, found.best));
    }
    study.whiten_with(found.best.nuisance);
    found.base.train = study.base_train();
  }
}

}  // namespace crane::diagnosis
