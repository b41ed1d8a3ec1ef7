#include "study/whitened_data.hpp"

#include <utility>

namespace crane::diagnosis {
double difference_step(const FreeParameter& p, double value) {
  constexpr double kShare = 0.3;
  const double step = kShare * p.step;
  if (value + step <= p.high) return step;
  if (value - step >= p.low) return -step;
  return p.high - value > value - p.low ? p.high - value : p.low - value;
}

WhitenedData::WhitenedData(const Study& study, Nuisance nuisance)
    : study_(study),
      nuisance_(std::move(nuisance)),
      body_(study.train(), nuisance_, replays_of(study.train().runs, study.base())) {}

Crane WhitenedData::with(const Effects& effects) const {
  return study_.crane(nuisance_.inaccuracies, effects);
}

Evaluation WhitenedData::base() const { return diagnosis::evaluated(body_, replays_of(runs(), with({}))); }

Evaluation WhitenedData::evaluated(const Effects& effects, const Evaluation& near) const {
  return evaluated_near(body_, replays_of(runs(), with(effects)), shown_in(effects), near);
}

Evaluation WhitenedData::evaluated_again(const Fitted& fitted) const {
  return diagnosis::evaluated_again(body_, replays_of(runs(), with(fitted.effects)), fitted.train);
}

PlainSlope WhitenedData::plain_slope(const Replays& crane, const Evaluation& at, double step, ShowsIn parts,
                                     const PartVectors& unmoved) const {
  PlainSlope slope;
  if (parts.drive && !drive().empty()) {
    slope.drive = drive().plain_change(crane, at.drive, step);
    slope.equation_error = body_.equation_error.plain_residuals(crane);
    for (std::size_t k = 0; k < unmoved.size(); ++k)
      slope.equation_error[k] = (unmoved[k] - slope.equation_error[k]) / step;
  }
  if (parts.load && !load().empty()) slope.load = load().plain_change(crane, at.load, step);
  return slope;
}

Slopes WhitenedData::plain_slopes(const Effects& effects, const Evaluation& at, Slopes known) const {
  std::size_t value_index = 0;
  PartVectors unmoved;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const Candidate& candidate = *effects[e].candidate;
    for (std::size_t i = 0; i < candidate.parameters.size(); ++i, ++value_index) {
      if (value_index == known.size()) known.push_back({});
      const ShowsIn missing{candidate.drive && !drive().empty() && known.drive[value_index].empty(),
                            candidate.load && !load().empty() && known.load[value_index].empty()};
      if (!missing.drive && !missing.load) continue;
      if (missing.drive && unmoved.empty())
        unmoved = body_.equation_error.plain_residuals(replays_of(runs(), with(effects)));
      Effects moved = effects;
      double& value = moved[e].values[i];
      const double step = difference_step(candidate.parameters[i], value);
      value += step;
      PlainSlope slope = plain_slope(replays_of(runs(), with(moved)), at, step, missing, unmoved);
      if (missing.drive) known.drive[value_index] = std::move(slope.drive);
      if (missing.drive) known.equation_error[value_index] = std::move(slope.equation_error);
      if (missing.load) known.load[value_index] = std::move(slope.load);
    }
  }
  return known;
}

Slopes WhitenedData::whitened(const Slopes& plain, const Evaluation& at) const {
  Slopes result{drive().whitened(plain.drive, at.drive), {}, load().whitened(plain.load, at.load)};
  for (const PartVectors& slope : plain.equation_error)
    result.equation_error.push_back(slope.empty() ? PartVectors{} : body_.equation_error.whitened(slope));
  return result;
}

BlockScores WhitenedData::scores(const Evaluation& at, const Slopes& slopes, Loss loss) const {
  BlockScores scores = block_scores(drive(), at.drive, slopes.drive, loss);
  add_scores(body_.equation_error.windows(), at.equation_error, slopes.equation_error, loss, scores);
  return joined(scores, block_scores(load(), at.load, slopes.load, loss));
}

}  // namespace crane::diagnosis
