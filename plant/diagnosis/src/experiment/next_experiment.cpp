#include "experiment/next_experiment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "crane/plant/pendulum.hpp"

#include "experiment/motion_menu.hpp"
#include "experiment/safe_run.hpp"
#include "noise/motion_profile.hpp"
#include "parallel.hpp"
#include "search/compare.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kExperimentWindow_s = 2.5;
constexpr double kExperimentLead_s = 0.3;  // fills the memory of terms; not compared
constexpr double kLeastSeparation = 10;
constexpr int kMostRefitRounds = 10;
constexpr double kLeastDecrease = 1;        // of the sum of squares, for another round
constexpr double kShortestStepShare = 0.1;  // of the Gauss-Newton step
constexpr std::size_t kWindowStride = 2;    // every second window is compared: enough to rank motions

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

Crane with(Crane crane, const Effects& effects) {
  for (const Effect& effect : effects) crane.terms.push_back(effect.candidate->setting(effect.values));
  return crane;
}

/// Whitened misfit of a crane to one run in one part. Starts of windows are projected out along the
/// directions of the first crane.
class WindowMisfit {
 public:
  /// @param gravity_mps2 for the swing's frequency
  WindowMisfit(const PreparedRun& run, Part part, double gravity_mps2, const Disturbances& disturbances)
      : run_(run), part_(part), outputs_(simulated_outputs(run, part)) {
    const double period_s = run.run.period_s;
    rows_ = std::min(static_cast<std::size_t>(std::lround(kExperimentWindow_s / period_s)), run.run.rows());
    lead_ = static_cast<std::size_t>(std::lround(kExperimentLead_s / period_s));
    for (const Output output : outputs_)
      for (std::size_t w = 0; w < windows(); ++w) {
        const std::size_t first = first_of(w) + lead_, kept = rows_ - lead_;
        const WindowMotion motion =
            part == Part::drive
                ? WindowMotion{period_s, 0, motion_profile_of(run.on_grid[output], period_s, first, kept)}
                : WindowMotion{period_s, plant::swing_radps(gravity_mps2, run.run.cable_m[first]),
                               MotionProfile(kept)};
        whiteners_.emplace_back(disturbances[output], motion);
      }
  }

  [[nodiscard]] const std::vector<Output>& outputs() const { return outputs_; }

  /// One column per output: windows one after the other.
  MatrixXd misfit(const Crane& crane) {
    const auto kept = static_cast<Index>(rows_ - lead_), columns = static_cast<Index>(outputs_.size());
    MatrixXd all(static_cast<Index>(windows()) * kept, columns);
    if (outputs_.empty()) return all;
    const Replay replay(run_, crane);
    const bool first_time = bases_.empty();
    for (std::size_t w = 0; w < windows(); ++w) {
      const auto start = replay.measured_start(part_, first_of(w));
      const VectorXd simulated = simulate(replay, w, start);
      VectorXd residual = measured(w) - simulated;
      whiten(w, residual);
      if (first_time) bases_.push_back(start_directions(replay, w, start, simulated));
      residual -= bases_[w] * (bases_[w].transpose() * residual);
      for (Index i = 0; i < columns; ++i)
        all.block(static_cast<Index>(w) * kept, i, kept, 1) = residual.segment(i * kept, kept);
    }
    return all;
  }

 private:
  [[nodiscard]] std::size_t windows() const {
    return (run_.run.rows() / rows_ + kWindowStride - 1) / kWindowStride;
  }
  [[nodiscard]] std::size_t first_of(std::size_t window) const { return window * kWindowStride * rows_; }
  void whiten(std::size_t window, Eigen::Ref<MatrixXd> x) const {
    const auto kept = static_cast<Index>(rows_ - lead_);
    for (std::size_t i = 0; i < outputs_.size(); ++i)
      whiteners_[i * windows() + window].apply(x.middleRows(static_cast<Index>(i) * kept, kept));
  }
  /// Rows after the lead.
  [[nodiscard]] VectorXd kept_of(const std::vector<double>& values) const {
    const auto kept = static_cast<Index>(rows_ - lead_);
    VectorXd result(kept * static_cast<Index>(outputs_.size()));
    for (std::size_t i = 0; i < outputs_.size(); ++i)
      result.segment(static_cast<Index>(i) * kept, kept) =
          Eigen::Map<const VectorXd>(values.data() + i * rows_ + lead_, kept);
    return result;
  }
  [[nodiscard]] VectorXd simulate(const Replay& replay, std::size_t window,
                                  const std::vector<double>& start) const {
    std::vector<double> values(outputs_.size() * rows_);
    replay.run(part_, first_of(window), rows_, start, values);
    return kept_of(values);
  }
  [[nodiscard]] VectorXd measured(std::size_t window) const {
    std::vector<double> values;
    for (const Output output : outputs_) {
      const auto first = run_.run.measured[output].begin() + static_cast<std::ptrdiff_t>(first_of(window));
      values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(rows_));
    }
    return kept_of(values);
  }
  /// Orthonormal directions of the start.
  [[nodiscard]] MatrixXd start_directions(const Replay& replay, std::size_t window,
                                          const std::vector<double>& start, const VectorXd& at) const {
    constexpr double kStep = 1e-4;
    MatrixXd slopes(at.size(), static_cast<Index>(start.size()));
    for (std::size_t i = 0; i < start.size(); ++i) {
      auto moved = start;
      moved[i] += kStep;
      slopes.col(static_cast<Index>(i)) = (simulate(replay, window, moved) - at) / kStep;
    }
    whiten(window, slopes);
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(slopes);
    return qr.householderQ() * MatrixXd::Identity(slopes.rows(), qr.rank());
  }

  const PreparedRun& run_;
  Part part_;
  std::vector<Output> outputs_;
  std::vector<Whitener> whiteners_;  ///< by output, then window
  std::size_t rows_ = 0, lead_ = 0;
  std::vector<MatrixXd> bases_;
};

/// Refits a hypothesis to one run, in the parts that its causes act on.
class Refit {
 public:
  Refit(const Crane& base, const PreparedRun& run, const Disturbances& disturbances,
        const std::vector<const Candidate*>& causes)
      : base_(base) {
    const double g = base.parameters.gravity_mps2;
    const auto any = [&](bool Candidate::*shows) {
      return std::any_of(causes.begin(), causes.end(), [&](const Candidate* c) { return c->*shows; });
    };
    if (any(&Candidate::drive)) parts_.emplace_back(run, Part::drive, g, disturbances);
    if (any(&Candidate::load)) parts_.emplace_back(run, Part::load, g, disturbances);
  }

  /// Misfit of each part.
  [[nodiscard]] std::vector<MatrixXd> misfits(const Effects& effects) {
    const Crane crane = with(base_, effects);
    std::vector<MatrixXd> all;
    for (WindowMisfit& part : parts_) all.push_back(part.misfit(crane));
    return all;
  }

  /// Gauss-Newton with step halving, inside the bounds. The base model, without effects, has no values to
  /// fit.
  void fit(Effects& effects) {
    if (effects.empty()) return;
    VectorXd residual = stacked(misfits(effects));
    for (int round = 0; round < kMostRefitRounds; ++round) {
      const VectorXd change = step(effects, residual);
      if (!change.allFinite()) return;  // a slope at which the replay diverges
      double gain = 0;
      for (double share = 1; share > kShortestStepShare && gain <= 0; share *= 0.5) {
        const Effects next = moved(effects, share * change);
        const VectorXd after = stacked(misfits(next));
        gain = residual.squaredNorm() - after.squaredNorm();
        if (gain > 0) effects = next, residual = after;
      }
      if (gain < kLeastDecrease) return;
    }
  }

 private:
  static VectorXd stacked(const std::vector<MatrixXd>& parts) {
    Index size = 0;
    for (const MatrixXd& part : parts) size += part.size();
    VectorXd all(size);
    Index at = 0;
    for (const MatrixXd& part : parts) {
      all.segment(at, part.size()) = part.reshaped();
      at += part.size();
    }
    return all;
  }
  [[nodiscard]] VectorXd step(const Effects& at, const VectorXd& residual) {
    std::vector<VectorXd> slopes;
    for (std::size_t e = 0; e < at.size(); ++e)
      for (std::size_t i = 0; i < at[e].values.size(); ++i) {
        const FreeParameter& parameter = at[e].candidate->parameters[i];
        Effects there = at;
        double& value = there[e].values[i];
        value += value + parameter.step <= parameter.high ? parameter.step : -parameter.step;
        slopes.emplace_back((residual - stacked(misfits(there))) / (value - at[e].values[i]));
      }
    MatrixXd all(residual.size(), static_cast<Index>(slopes.size()));
    for (std::size_t i = 0; i < slopes.size(); ++i) all.col(static_cast<Index>(i)) = slopes[i];
    return all.colPivHouseholderQr().solve(residual);
  }

  Crane base_;
  std::vector<WindowMisfit> parts_;
};

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

Disturbances disturbances_of(const Study& study) {
  constexpr double kUninformativeNoise = 1e6;  // m or rad
  Disturbances disturbances{};
  for (Disturbance& disturbance : disturbances) disturbance.noise = kUninformativeNoise;
  for (const Problem* problem : {&study.drive(), &study.load()})
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
