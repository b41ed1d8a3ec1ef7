#include "tuning/second_mode.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "crane/identification/friction.hpp"
#include "crane/plant/coordinates.hpp"

namespace crane::tuning {
namespace {

// A residual above this multiple of the quantisation noise may hide a second mode. Chosen; hidden gantries
// with one mode have a ratio of 1.0.
constexpr double kUnexplained = 3;
// A second mode must halve the residual. Chosen.
constexpr double kExplains = 0.5;
// Lower bound of the share of the lower mass in the fit: at 0 the lower length has no effect. Chosen.
constexpr double kLeastShare = 0.02;
// Standard errors by which the share of the lower mass must differ from 0.
constexpr double kSignificant = 4;

/// Quantisation noise of the compared swing angles, rms.
double quantisation_rad(const diagnosis::PreparedRun& run, bool tower) {
  const double radial = run.least_noise[diagnosis::kRadialSwing];
  return tower ? std::hypot(radial, run.least_noise[diagnosis::kTangentialSwing]) / std::sqrt(2) : radial;
}

std::vector<FitParameter> parameters(const LoadFit& load, bool tower, double share, double length_m,
                                     double raised_m) {
  const double cable_m = load.cable_m.value;
  std::vector<FitParameter> list{{"lower_share", share, kLeastShare, largest_lower_share(), 1e-3},
                                 {"lower_length", length_m, 0.03, 2 * cable_m, 1e-3},
                                 {"hook_raised", raised_m, 0, 0.9 * cable_m, 1e-3},
                                 {"rest_radial", load.rest_angle_rad[0].value, -0.5, 0.5, 1e-4}};
  if (tower) list.push_back({"rest_tangential", load.rest_angle_rad[1].value, -0.5, 0.5, 1e-4});
  return list;
}

/// @return the two of six sets of initial values with the smallest residuals. The first mode of each set has
/// about the frequency of the single pendulum.
std::vector<std::vector<FitParameter>> best_initial_values(const std::vector<diagnosis::PreparedRun>& runs,
                                                           const WindowedFit& fit, const LoadFit& load,
                                                           bool tower) {
  std::vector<std::pair<double, std::vector<FitParameter>>> sets;
  for (const double share : {0.2, 0.6})
    for (const double of_cable : {0.1, 0.25, 0.5}) {
      const double length_m = of_cable * load.cable_m.value;
      auto set = parameters(load, tower, share, length_m, share * length_m);
      sets.emplace_back(residual_rms(runs, fit, set), std::move(set));
    }
  std::ranges::sort(sets, {}, [](const auto& set) { return set.first; });
  return {sets[0].second, sets[1].second};
}

}  // namespace

std::optional<SecondMode> find_second_mode(const std::vector<diagnosis::PreparedRun>& runs,
                                           const configuration::Rig& rig, const LoadFit& load) {
  const bool tower = rig.measures(plant::kSwingTangential);
  if (load.residual_rms < kUnexplained * quantisation_rad(runs.front(), tower)) return std::nullopt;
  auto fit = load_fit(tower);
  fit.crane = [&](const std::vector<double>& v) {
    auto crane = crane_with(rig, load.cable_m.value, {v[3], tower ? v[4] : 0.0});
    crane.terms.push_back(double_pendulum_term(v[0], v[1], v[2]));
    return crane;
  };
  std::optional<FitResult> best;
  for (const auto& initial : best_initial_values(runs, fit, load, tower)) try {
      auto result = fit_windows(runs, fit, initial);
      if (!best || result.residual_rms < best->residual_rms) best = std::move(result);
    } catch (const identification::IdentificationError&) {
      continue;  // these initial values do not lead to the second mode
    }
  if (!best || best->residual_rms > kExplains * load.residual_rms ||
      best->values[0] < kSignificant * best->standard_errors[0])
    return std::nullopt;
  const auto value = [&best](std::size_t i) { return Value{best->values[i], best->standard_errors[i]}; };
  return SecondMode{.lower_share = value(0),
                    .lower_length_m = value(1),
                    .hook_raised_m = value(2),
                    .rest_angle_rad = {value(3), tower ? value(4) : Value{}},
                    .residual_rms = best->residual_rms};
}

}  // namespace crane::tuning
