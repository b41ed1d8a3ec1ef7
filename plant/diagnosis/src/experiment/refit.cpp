#include "experiment/refit.hpp"

#include <algorithm>
#include <cmath>

#include "crane/plant/pendulum.hpp"

#include "noise/motion_profile.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kExperimentWindow_s = 2.5;
constexpr double kExperimentLead_s = 0.3;  // fills the memory of terms; not compared
constexpr int kMostRefitRounds = 10;
constexpr double kLeastDecrease = 1;        // of the sum of squares, for another round
constexpr double kShortestStepShare = 0.1;  // of the Gauss-Newton step

VectorXd stacked(const std::vector<MatrixXd>& parts) {
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

}  // namespace

Crane with(Crane crane, const Effects& effects) {
  for (const Effect& effect : effects) crane.terms.push_back(effect.candidate->setting(effect.values));
  return crane;
}

WindowMisfit::WindowMisfit(const PreparedRun& run, Part part, double gravity_mps2,
                           const Disturbances& disturbances)
    : run_(run), part_(part), outputs_(simulated_outputs(run, part)) {
  const double period_s = run.run.period_s;
  rows_ = std::min(static_cast<std::size_t>(std::lround(kExperimentWindow_s / period_s)), run.run.rows());
  lead_ = static_cast<std::size_t>(std::lround(kExperimentLead_s / period_s));
  for (const Output output : outputs_)
    for (std::size_t w = 0; w < windows(); ++w) {
      const std::size_t first = first_of(w) + lead_, kept = rows_ - lead_;
      const WindowMotion motion =
          part == Part::drive
              ? WindowMotion{period_s, 0, motion_profile_of(run, output, first, kept)}
              : WindowMotion{period_s, plant::swing_radps(gravity_mps2, run.run.cable_m[first]),
                             MotionProfile(kept)};
      whiteners_.emplace_back(disturbances[output], motion);
    }
}

MatrixXd WindowMisfit::misfit(const Crane& crane) {
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

std::size_t WindowMisfit::windows() const {
  return (run_.run.rows() / rows_ + kWindowStride - 1) / kWindowStride;
}

void WindowMisfit::whiten(std::size_t window, Eigen::Ref<MatrixXd> x) const {
  const auto kept = static_cast<Index>(rows_ - lead_);
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    whiteners_[i * windows() + window].apply(x.middleRows(static_cast<Index>(i) * kept, kept));
}

VectorXd WindowMisfit::kept_of(const std::vector<double>& values) const {
  const auto kept = static_cast<Index>(rows_ - lead_);
  VectorXd result(kept * static_cast<Index>(outputs_.size()));
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    result.segment(static_cast<Index>(i) * kept, kept) =
        Eigen::Map<const VectorXd>(values.data() + i * rows_ + lead_, kept);
  return result;
}

VectorXd WindowMisfit::simulate(const Replay& replay, std::size_t window,
                                const std::vector<double>& start) const {
  std::vector<double> values(outputs_.size() * rows_);
  replay.run(part_, first_of(window), rows_, start, values);
  return kept_of(values);
}

VectorXd WindowMisfit::measured(std::size_t window) const {
  std::vector<double> values;
  for (const Output output : outputs_) {
    const auto first = run_.run.measured[output].begin() + static_cast<std::ptrdiff_t>(first_of(window));
    values.insert(values.end(), first, first + static_cast<std::ptrdiff_t>(rows_));
  }
  return kept_of(values);
}

MatrixXd WindowMisfit::start_directions(const Replay& replay, std::size_t window,
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

Refit::Refit(const Crane& base, const PreparedRun& run, const Disturbances& disturbances,
             const std::vector<const Candidate*>& causes)
    : base_(base) {
  const double g = base.parameters.gravity_mps2;
  const auto any = [&](bool Candidate::*shows) {
    return std::any_of(causes.begin(), causes.end(), [&](const Candidate* c) { return c->*shows; });
  };
  if (any(&Candidate::drive)) parts_.emplace_back(run, Part::drive, g, disturbances);
  if (any(&Candidate::load)) parts_.emplace_back(run, Part::load, g, disturbances);
}

std::vector<MatrixXd> Refit::misfits(const Effects& effects) {
  const Crane crane = with(base_, effects);
  std::vector<MatrixXd> all;
  for (WindowMisfit& part : parts_) all.push_back(part.misfit(crane));
  return all;
}

void Refit::fit(Effects& effects) {
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

VectorXd Refit::step(const Effects& at, const VectorXd& residual) {
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

}  // namespace crane::diagnosis
