#include "study/body.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "robust.hpp"
#include "study/blocks.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::VectorXd;

/// Window lengths. In a longer window of a drive that sticks and slips, late or missing slips dominate the
/// residual and hide the error of the friction.
constexpr double kShortestSwingWindow_s = 2, kDriveWindow_s = 1;

/// A window contains a period of the swing: the start of a shorter one explains most errors of the load.
double swing_window_s(double natural_radps) {
  return natural_radps > 0 ? std::max(kShortestSwingWindow_s, 2 * std::numbers::pi / natural_radps)
                           : kShortestSwingWindow_s;
}

Problem whitened_with(const Problem& plain, const std::vector<Disturbance>& disturbances) {
  return plain.empty() ? plain : plain.whitened_with(disturbances);
}

Problem whitened_by(const Problem& plain, const Replays& crane) {
  return plain.empty() ? plain : plain.whitened_by(crane);
}

/// Rms difference between two simulations, as a share of the rms motion, up to which the slopes of one serve
/// as slopes of the other: a direction whose cosine to the true one is sqrt(1 - kAlikeShare^2) has all but 4
/// % of its information.
constexpr double kAlikeShare = 0.2;

/// Whether the simulations in windows differ by at most kAlikeShare of the motion, in each output.
bool moves_alike(const Problem& problem, const Fits& fits, const PartVectors& other) {
  for (std::size_t output = 0; output < problem.outputs().size(); ++output) {
    double difference = 0, motion = 0;
    for (std::size_t w = 0; w < fits.size(); ++w) {
      const auto rows = static_cast<Eigen::Index>(problem.windows()[w].rows);
      const auto first = static_cast<Eigen::Index>(output) * rows;
      const VectorXd now = fits[w].simulated.segment(first, rows);
      difference += (now - other[w].segment(first, rows)).squaredNorm();
      motion += (now.array() - now.mean()).matrix().squaredNorm();
    }
    if (!(difference <= kAlikeShare * kAlikeShare * motion)) return false;
  }
  return true;
}

Evaluation summed(const Body& body, Fits of_drive, Fits of_load, std::vector<VectorXd> equation_error) {
  Evaluation result;
  result.drive = std::move(of_drive);
  result.load = std::move(of_load);
  result.equation_error = std::move(equation_error);
  result.blocks = blocks_of(body.drive, result.drive);
  for (std::size_t i = 0; i < result.equation_error.size(); ++i)
    result.blocks[body.equation_error.windows()[i]] += loss_of(result.equation_error[i]);
  const Blocks more = blocks_of(body.load, result.load);
  result.drive_blocks = result.blocks.size();
  result.drive_loss = sum(result.blocks);
  result.load_loss = sum(more);
  result.loss = result.drive_loss + result.load_loss;
  result.blocks.insert(result.blocks.end(), more.begin(), more.end());
  return result;
}

}  // namespace

Body::Body(const Runs& all, double natural_radps)
    : runs(all),
      drive(all, Part::drive, kDriveWindow_s, natural_radps),
      load(all, Part::load, swing_window_s(natural_radps), natural_radps),
      equation_error(drive) {}

Body::Body(const Body& plain, const Replays& crane)
    : runs(plain.runs),
      drive(whitened_by(plain.drive, crane)),
      load(whitened_by(plain.load, crane)),
      equation_error(drive, crane) {}

Body::Body(const Body& plain, const Nuisance& nuisance, const Replays& crane)
    : runs(plain.runs),
      drive(whitened_with(plain.drive, nuisance.drive)),
      load(whitened_with(plain.load, nuisance.load)),
      equation_error(drive, nuisance.equation_error, crane) {}

Evaluation evaluated(const Body& body, const Replays& crane) {
  const auto fit = [&crane](const Problem& problem) { return problem.empty() ? Fits{} : problem.fit(crane); };
  return summed(body, fit(body.drive), fit(body.load), body.equation_error.residuals(crane));
}

Evaluation evaluated_again(const Body& body, const Replays& crane, const Evaluation& near) {
  const auto again = [&crane](const Problem& problem, const Fits& fits) {
    return problem.empty() ? Fits{} : problem.fit_again(crane, fits);
  };
  return summed(body, again(body.drive, near.drive), again(body.load, near.load),
                body.equation_error.residuals(crane));
}

Evaluation evaluated_near(const Body& body, const Replays& crane, ShowsIn parts, const Evaluation& near) {
  return summed(body, parts.drive ? body.drive.fit_near(crane, near.drive) : near.drive,
                parts.load ? body.load.fit_near(crane, near.load) : near.load,
                parts.drive ? body.equation_error.residuals(crane) : near.equation_error);
}

Simulation simulation_of(const Evaluation& at) {
  Simulation simulation;
  for (const WindowFit& fit : at.drive) simulation.drive.push_back(fit.simulated);
  for (const WindowFit& fit : at.load) simulation.load.push_back(fit.simulated);
  return simulation;
}

ShowsIn unlike(const Body& body, const Effects& effects, const Evaluation& at, const Simulation& other) {
  const ShowsIn visible = shown_in(effects);
  if (other.drive.empty() && other.load.empty()) return visible;
  return {visible.drive && !moves_alike(body.drive, at.drive, other.drive),
          visible.load && !moves_alike(body.load, at.load, other.load)};
}

Nuisance noise_of(const Body& body, const Evaluation& at, const Replays& crane) {
  Nuisance nuisance;
  if (!body.drive.empty()) {
    nuisance.drive = body.drive.disturbances_of(at.drive);
    nuisance.equation_error = body.equation_error.disturbances_of(crane);
  }
  if (!body.load.empty()) nuisance.load = body.load.disturbances_of(at.load);
  return nuisance;
}

Blocks deviance_of(const Body& body, const Evaluation& at) {
  Blocks deviance = at.blocks;
  for (double& block : deviance) block /= kLossPerDeviance;
  const auto add = [&deviance](std::size_t first, const Blocks& more) {
    for (std::size_t i = 0; i < more.size(); ++i) deviance[first + i] += more[i];
  };
  add(0, log_variances_of(body.drive));
  const std::vector<double> of_pieces = body.equation_error.log_variances();
  for (std::size_t i = 0; i < of_pieces.size(); ++i)
    deviance[body.equation_error.windows()[i]] += of_pieces[i];
  add(at.drive_blocks, log_variances_of(body.load));
  return deviance;
}

}  // namespace crane::diagnosis
