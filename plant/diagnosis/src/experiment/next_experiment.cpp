#include "experiment/next_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiment/motion_menu.hpp"
#include "experiment/refit.hpp"
#include "experiment/safe_run.hpp"
#include "parallel.hpp"
#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;

constexpr double kLeastSeparation = 10;

/// Candidates that only one of the two hypotheses contains.
std::vector<const Candidate*> differing(const Effects& a, const Effects& b) {
  std::vector<const Candidate*> all;
  for (const auto& [one, other] : {std::pair{&a, &b}, {&b, &a}})
    for (const Effect& effect : *one)
      if (!has(*other, effect.candidate)) all.push_back(effect.candidate);
  return all;
}

/// Start of the refit: `other` with the values of `truth` for common candidates.
Effects beginning_at(const Effects& truth, Effects other) {
  for (Effect& effect : other)
    for (const Effect& shared : truth)
      if (shared.candidate == effect.candidate) effect.values = shared.values;
  return other;
}

/// Whether the motion excites the causes: those of one drive need a reference of that drive.
bool excites(const SafeMotion& motion, const std::vector<const Candidate*>& causes) {
  const std::string& name = causes.front()->axis;
  const auto elsewhere = [&](const Candidate* cause) { return cause->axis != name; };
  if (std::any_of(causes.begin(), causes.end(), elsewhere) || (name != "trolley" && name != "slew"))
    return true;
  const plant::Axis axis = plant::drive_axis(name);
  return std::any_of(motion.references.begin(), motion.references.end(),
                     [axis](const TimedExcitation& part) { return part.reference.axis == axis; });
}

/// Separation of `rival`, refitted, from `truth` in the most sensitive column, in standard deviations of the
/// noise. Nothing if the motion is not safe for the true crane.
std::optional<double> separation_of(const configuration::Rig& rig, const SafeMotion& motion,
                                    const Effects& truth, const Effects& rival,
                                    const Disturbances& disturbances) {
  Crane base{rig.plant, rig.terms};
  base.parameters.load_mass_kg = motion.load_mass_kg;
  const auto run = safe_run(rig, with(base, truth), motion);
  if (!run) return std::nullopt;
  Refit refit(base, *run, disturbances, differing(truth, rival));
  Effects nearest = beginning_at(truth, rival);
  refit.fit(nearest);
  const auto left = refit.misfits(nearest),
             own = refit.misfits(truth);  // the replay of smoothed data has a small residual
  double most = 0;
  for (std::size_t part = 0; part < left.size(); ++part)
    for (Index i = 0; i < left[part].cols(); ++i) {
      const double more = left[part].col(i).squaredNorm() - own[part].col(i).squaredNorm();
      most = std::max(most, std::sqrt(static_cast<double>(kWindowStride) * std::max(0.0, more)));
    }
  return most;
}

}  // namespace

Disturbances disturbances_of(const WhitenedData& data) {
  constexpr double kUninformativeNoise = 1e6;  // m or rad
  Disturbances disturbances{};
  for (Disturbance& disturbance : disturbances) disturbance.noise = kUninformativeNoise;
  for (const Problem* problem : {&data.drive(), &data.load()})
    for (std::size_t i = 0; i < problem->disturbances().size(); ++i)
      disturbances[problem->outputs()[i]] = problem->disturbances()[i];
  return disturbances;
}

namespace {

constexpr std::optional<double> kImitated = std::numeric_limits<double>::infinity();

/// True when every cause of `part` is one of `whole`.
bool contains(const Effects& whole, const Effects& part) {
  return std::ranges::all_of(part, [&](const Effect& e) { return has(whole, e.candidate); });
}

}  // namespace

std::optional<NextExperiment> propose_experiment(const configuration::Rig& rig, const Effects& a,
                                                 const Effects& b, const Disturbances& disturbances) {
  const std::vector<const Candidate*> causes = differing(a, b);
  if (causes.empty()) return std::nullopt;
  const auto menu = motion_menu(rig);
  std::vector<double> separations(menu.size(), 0.0);
  parallel_for(menu.size(), [&](std::size_t i) {
    if (!excites(menu[i], causes)) return;
    // A hypothesis that contains the true one imitates it exactly: only the larger one can be the truth.
    const auto one = contains(b, a) ? kImitated : separation_of(rig, menu[i], a, b, disturbances);
    if (!one) return;
    const auto other = contains(a, b) ? kImitated : separation_of(rig, menu[i], b, a, disturbances);
    if (other) separations[i] = std::min(*one, *other);
  });
  const auto best = std::max_element(separations.begin(), separations.end());
  if (best == separations.end() || *best < kLeastSeparation) return std::nullopt;
  const SafeMotion& motion = menu[static_cast<std::size_t>(best - separations.begin())];
  return NextExperiment{.name = motion.name,
                        .description = motion.description,
                        .separation = *best,
                        .scenario = scenario_text(motion, rig)};
}

}  // namespace crane::diagnosis
