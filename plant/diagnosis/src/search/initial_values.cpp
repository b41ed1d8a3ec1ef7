#include "search/initial_values.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "force/force_lines.hpp"
#include "search/parts.hpp"

namespace crane::diagnosis {
namespace {

/// The starts with the lowest loss.
Effects best_of(const WhitenedData& data, const std::vector<Effects>& starts, const Fitted& near) {
  if (starts.size() == 1) return starts[0];
  const Effects* best = &starts[0];
  double least = std::numeric_limits<double>::infinity();
  for (const Effects& start : starts)
    if (const double loss = data.evaluated(start, near.train).loss; loss < least) least = loss, best = &start;
  return *best;
}

}  // namespace

Effects InitialValues::of(const WhitenedData& data, const Fitted& given, const Score& score) {
  const Candidate* candidate = &data.study().candidates()[score.candidate];
  const auto compared = best_ringing_.find(candidate);
  std::vector<std::vector<double>> values = score.starts;
  if (compared != best_ringing_.end()) {
    std::erase_if(values, [&](const auto& known) {
      return std::ranges::find(compared->second.all, known) != compared->second.all.end();
    });
    values.push_back(compared->second.best);
  }
  std::vector<Effects> starts;
  for (const std::vector<double>& of_start : values) {
    starts.push_back(given.effects);
    starts.back().push_back({candidate, of_start});
  }
  const Effects best = best_of(data, starts, given);
  if (candidate->ringing_starts_at) {
    Ringing& ringing = best_ringing_[candidate];
    ringing.best = best.back().values;
    ringing.all.insert(ringing.all.end(), values.begin(), values.end());
  }
  return best;
}

std::vector<const Candidate*> InitialValues::add_of_lines(const WhitenedData& data, const Fitted& given,
                                                          std::uint64_t seed, ScoreTable& scores) const {
  std::vector<double> lines_hz;
  for (std::size_t output = 0; output < data.load().outputs().size(); ++output)
    if (const auto line = find_force_line(pieces_of(data.load(), given.train.load, output), seed))
      lines_hz.push_back(line->hz);
  std::vector<const Candidate*> ringing;
  for (Score& score : scores.best) {
    const Candidate& candidate = data.study().candidates()[score.candidate];
    if (!candidate.ringing_starts_at) continue;
    const std::size_t known = score.starts.size();
    for (const double hz : lines_hz)
      for (std::vector<double>& values : candidate.ringing_starts_at(hz))
        if (candidate.permits(values)) score.starts.push_back(std::move(values));
    if (score.starts.size() > known) ringing.push_back(&candidate);
  }
  return ringing;
}

Effects InitialValues::with_new_wave(const WhitenedData& data, const Effects& effects,
                                     const Fitted& near) const {
  std::vector<Effects> starts{effects};
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const Candidate& wave = *effects[i].candidate;
    if (!wave.waves) continue;
    const Effects others = without(effects, i);
    const auto changes_positions = [&](const Effect& other) {
      return other.candidate->axis == wave.axis && other.candidate->load;
    };
    if (std::ranges::none_of(others, changes_positions)) continue;
    for (const Shape& shape : shapes_of(data, wave, others)) {
      starts.push_back(effects);
      starts.back()[i].values = wave.begin(shape, shape.amounts);
    }
  }
  return best_of(data, starts, near);
}

}  // namespace crane::diagnosis
