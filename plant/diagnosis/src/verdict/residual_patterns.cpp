#include "verdict/residual_patterns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "force/force_lines.hpp"
#include "force/jumps.hpp"
#include "rules.hpp"
#include "verdict/missing_force.hpp"

namespace crane::diagnosis {
namespace {

/// Length of the windows in which patterns and short forces of the swing are sought. In a window of one
/// period, the start explains a constant force.
constexpr double kPatternWindow_periods = 5;

double squares_of(const std::vector<Eigen::VectorXd>& residuals) {
  double sum = 0;
  for (const Eigen::VectorXd& residual : residuals) sum += residual.squaredNorm();
  return sum;
}

/// True if the law of the candidate depends on the variable of the pattern.
bool of_its_own(const Candidate& candidate, const Unexplained& left) {
  return candidate.law == left.with && candidate.axis == axis_of(left.output);
}

/// Largest share of the squares of the base model that a pattern may explain without contradicting the
/// hypothesis. The equation of a term is not exact: beside one cause that depends on the same variable, a
/// larger pattern is permitted. Several causes that depend on the same variable match any form together. No
/// term of a drive depends on time.
double largest_permitted_share(const Unexplained& left, const Effects& effects) {
  if (left.with == GoesWith::time) return rules::kPatternShareOverTime;
  const auto laws = std::count_if(effects.begin(), effects.end(),
                                  [&](const Effect& effect) { return of_its_own(*effect.candidate, left); });
  return laws == 0   ? rules::kPatternShare
         : laws == 1 ? rules::kPatternShareOneTerm
                     : rules::kPatternShareSeveralTerms;
}

/// Decrease of the sum of squares of a drive by each of the effects; infinite for an effect on another axis.
std::vector<double> explained_by_each(const WhitenedData& data, const Effects& effects,
                                      const Pieces& pieces) {
  std::vector<double> explained(effects.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < explained.size(); ++i) {
    if (effects[i].candidate->axis != axis_of(pieces.output)) continue;
    Effects others = effects;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    explained[i] =
        squares_of(residuals_of(pieces, replays_of(*pieces.runs, data.with(others)))) - pieces.squares();
  }
  return explained;
}

/// Smallest decrease by any effect whose law has another variable than the pattern.
double weakest(const Effects& effects, const std::vector<double>& explained, const Unexplained& left) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < explained.size(); ++i)
    if (!of_its_own(*effects[i].candidate, left)) least = std::min(least, explained[i]);
  return least;
}

/// Acceleration of the axis per volt of its command, m/s^2/V or rad/s^2/V.
double volt_acceleration(const WhitenedData& data, Output axis) {
  const auto parameters = data.with({}).parameters;
  return axis == kSlewAngle ? parameters.slew_gain_radps2pv : parameters.trolley_gain_mps2pv;
}

}  // namespace

bool oscillates(const WhitenedData& data, const Effects& effects) {
  const Crane crane = data.with(effects);
  return !plant::Model(crane.parameters, crane.terms).ringing_coordinates().empty();
}

bool counts_as_pattern(const Pattern& pattern, const Effects& effects) {
  const Unexplained& u = pattern.what;
  const bool counts =
      u.with == GoesWith::frequency || (u.fraction > rules::kPattern && u.gain > rules::kPatternLuck);
  return counts && (effects.empty() || u.gain > largest_permitted_share(u, effects) * pattern.of_base ||
                    u.gain > rules::kPatternShareOfCause * pattern.of_weakest);
}

std::vector<Pattern> residual_patterns(const WhitenedData& data, const Hypotheses& hypotheses,
                                       const std::vector<LosingEncoder>& losing, std::uint64_t seed) {
  std::vector<Pattern> left;
  const Runs& runs = data.runs();
  const Effects& effects = hypotheses.best.effects;
  const bool oscillating = oscillates(data, effects);
  const Replays best = replays_of(runs, data.with(effects)), base = replays_of(runs, data.with({}));
  for (const Output axis : data.drive().outputs()) {
    const Pieces pieces = pieces_of(runs, best, axis);
    const double of_base = squares_of(residuals_of(pieces, base));
    const std::vector<double> by_each = explained_by_each(data, effects, pieces);
    const auto add = [&](const Unexplained& what) {
      left.push_back({what, of_base, weakest(effects, by_each, what)});
    };
    for (const Unexplained& pattern : find_unexplained(pieces)) add(pattern);
    if (!oscillating)
      if (const auto line = find_force_line(pieces, seed, volt_acceleration(data, axis))) add(*line);
    const bool loses = std::any_of(losing.begin(), losing.end(),
                                   [&](const LosingEncoder& encoder) { return encoder.axis == axis; });
    if (!loses)
      if (const auto jumps = find_jumps(pieces)) add(*jumps);
  }
  const Fits& of_load = hypotheses.best.train.load;
  for (std::size_t output = 0; output < data.load().outputs().size(); ++output)
    if (const auto line = find_force_line(pieces_of(data.load(), of_load, output), seed))
      left.push_back({*line, hypotheses.base.train.load_loss});
  std::sort(left.begin(), left.end(),
            [](const Pattern& a, const Pattern& b) { return a.what.gain > b.what.gain; });
  return left;
}

SwingResidual swing_residual(const WhitenedData& data, const Fitted& best, bool names_a_cause,
                             double permitted, std::uint64_t seed) {
  SwingResidual left;
  const Problem& load = data.load();
  if (load.empty()) return left;
  const double window_s =
      std::max(kBlock_s, kPatternWindow_periods * 2 * std::numbers::pi / data.study().natural_radps());
  const Replays crane = replays_of(load.runs(), data.with(best.effects));
  const Problem long_windows =
      Problem(load.runs(), Part::load, window_s, data.study().natural_radps()).whitened_by(crane);
  const Fits fits = long_windows.fit(crane);
  for (std::size_t output = 0; output < load.outputs().size(); ++output) {
    double beside_causes_rad = 0;
    for (const auto& change : best.change)
      beside_causes_rad = std::max(beside_causes_rad, rules::kLeastBeside * change[load.outputs()[output]]);
    const double permitted_rad = permitted * rms_motion(load, output),
                 noise_rad = measured_noise(load, output);
    std::vector<SwingPattern> found = find_swing_patterns(long_windows, fits, output, seed);
    if (!oscillates(data, best.effects))
      if (auto band = find_narrow_band(load, best.train.load, output)) found.push_back(std::move(*band));
    for (SwingPattern& pattern : found)
      if (pattern.rms_rad >
          std::max(beside_causes_rad, names_a_cause && pattern.of_own_swing ? noise_rad : permitted_rad))
        left.patterns.push_back(std::move(pattern));
    if (const auto force = find_short_force(long_windows, fits, output, permitted))
      left.forces.push_back(*force);
  }
  std::ranges::sort(left.patterns, [](const auto& a, const auto& b) { return a.rms_rad > b.rms_rad; });
  std::ranges::sort(left.forces, [](const auto& a, const auto& b) {
    return std::abs(a.share_of_weight) > std::abs(b.share_of_weight);
  });
  return left;
}

}  // namespace crane::diagnosis
