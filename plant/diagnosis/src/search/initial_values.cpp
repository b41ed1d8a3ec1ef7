#include "search/initial_values.hpp"

#include <algorithm>
#include <limits>

#include "search/parts.hpp"

namespace crane::diagnosis {

Effects InitialValues::best_of(const std::vector<Effects>& starts, const Fitted& near) const {
  if (starts.size() == 1) return starts[0];
  const Effects* best = &starts[0];
  double least = std::numeric_limits<double>::infinity();
  for (const Effects& start : starts)
    if (const double loss = study_.train(start, near.train).loss; loss < least) least = loss, best = &start;
  return *best;
}

Effects InitialValues::of(const Fitted& given, const Score& score) {
  const Candidate* candidate = &study_.candidates()[score.candidate];
  const auto compared = best_ringing_.find(candidate);
  std::vector<std::vector<double>> values = score.starts;
  if (compared != best_ringing_.end()) values = {compared->second};
  std::vector<Effects> starts;
  for (const std::vector<double>& of_start : values) {
    starts.push_back(given.effects);
    starts.back().push_back({candidate, of_start});
  }
  const Effects best = best_of(starts, given);
  if (!candidate->ringing_starts.empty()) best_ringing_[candidate] = best.back().values;
  return best;
}

Effects InitialValues::with_new_wave(const Effects& effects, const Fitted& near) const {
  std::vector<Effects> starts{effects};
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const Candidate& wave = *effects[i].candidate;
    if (!wave.waves) continue;
    const Effects others = without(effects, i);
    const auto changes_positions = [&](const Effect& other) {
      return other.candidate->axis == wave.axis && other.candidate->load;
    };
    if (std::ranges::none_of(others, changes_positions)) continue;
    for (const Shape& shape : study_.shapes_of(wave, others)) {
      starts.push_back(effects);
      starts.back()[i].values = wave.begin(shape, shape.amounts);
    }
  }
  return best_of(starts, near);
}

}  // namespace crane::diagnosis
