#include "experiment/next_experiment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "experiment/motion_menu.hpp"
#include "experiment/safe_run.hpp"
#include "noise/paces.hpp"
#include "parallel.hpp"

namespace crane::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPredicted_s = 2.5;
constexpr double kBefore_s = 0.3;  // terms with a memory fill it; not compared
constexpr double kLeastSeparation = 10;
constexpr int kRounds = 10;
constexpr double kLeastApproach = 1;  // of the sum of squares
constexpr double kLeastStep = 0.1;    // of the Gauss-Newton step
constexpr std::size_t kEvery = 2;     // windows compared: enough to rank motions

struct Hypothesis {
  const Candidate* candidate = nullptr;
  std::vector<double> values;
};

/// Misfit of a crane to one run in one part, whitened, output by output; the starts of windows are solved for
/// along the directions of the first crane that is asked.
class Comparison {
 public:
  /// @param gravity_mps2 for the swing's frequency
  Comparison(const PreparedRun& run, Part part, double gravity_mps2, const Disturbances& disturbances)
      : run_(run), part_(part), outputs_(simulated_outputs(run, part)) {
    const double period_s = run.run.period_s;
    rows_ = std::min(static_cast<std::size_t>(std::lround(kPredicted_s / period_s)), run.run.rows());
    lead_ = static_cast<std::size_t>(std::lround(kBefore_s / period_s));
    for (const Output output : outputs_)
      for (std::size_t w = 0; w < windows(); ++w) {
        const std::size_t first = first_of(w) + lead_, kept = rows_ - lead_;
        const Passage passage =
            part == Part::drive
                ? Passage{period_s, 0, paces_of(run.run.measured[output], period_s, first, kept)}
                : Passage{period_s, std::sqrt(gravity_mps2 / run.run.cable_m[first]), Paces(kept)};
        whiteners_.emplace_back(disturbances[output], passage);
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
  [[nodiscard]] std::size_t windows() const { return (run_.run.rows() / rows_ + kEvery - 1) / kEvery; }
  [[nodiscard]] std::size_t first_of(std::size_t window) const { return window * kEvery * rows_; }
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
  /// Orthonormal directions in which a change of the start moves the outputs.
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

/// The structured parts of one run in which either cause may show.
class Rival {
 public:
  Rival(const Crane& base, const PreparedRun& run, const Disturbances& disturbances, const Candidate& a,
        const Candidate& b)
      : base_(base) {
    const double g = base.parameters.gravity_mps2;
    if (a.drive || b.drive) parts_.emplace_back(run, Part::drive, g, disturbances);
    if (a.load || b.load) parts_.emplace_back(run, Part::load, g, disturbances);
  }

  /// Of each part.
  [[nodiscard]] std::vector<MatrixXd> misfits(const Hypothesis& hypothesis) {
    Crane crane = base_;
    crane.terms.push_back(hypothesis.candidate->setting(hypothesis.values));
    std::vector<MatrixXd> all;
    for (Comparison& part : parts_) all.push_back(part.misfit(crane));
    return all;
  }

  /// Gauss-Newton from the values given, inside the bounds.
  void refit(Hypothesis& hypothesis) {
    VectorXd residual = stacked(misfits(hypothesis));
    for (int round = 0; round < kRounds; ++round) {
      const VectorXd change = step(hypothesis, residual);
      double gain = 0;
      for (double share = 1; share > kLeastStep && gain <= 0; share *= 0.5) {
        Hypothesis next = hypothesis;
        for (std::size_t i = 0; i < next.values.size(); ++i)
          next.values[i] =
              within(*hypothesis.candidate, i, next.values[i] + share * change[static_cast<Index>(i)]);
        const VectorXd after = stacked(misfits(next));
        gain = residual.squaredNorm() - after.squaredNorm();
        if (gain > 0) hypothesis = next, residual = after;
      }
      if (gain < kLeastApproach) return;
    }
  }

 private:
  static double within(const Candidate& candidate, std::size_t parameter, double value) {
    return std::clamp(value, candidate.parameters[parameter].low, candidate.parameters[parameter].high);
  }
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
  [[nodiscard]] VectorXd step(const Hypothesis& at, const VectorXd& residual) {
    MatrixXd slopes(residual.size(), static_cast<Index>(at.values.size()));
    for (std::size_t i = 0; i < at.values.size(); ++i) {
      const FreeParameter& parameter = at.candidate->parameters[i];
      Hypothesis moved = at;
      moved.values[i] += at.values[i] + parameter.step <= parameter.high ? parameter.step : -parameter.step;
      slopes.col(static_cast<Index>(i)) =
          (residual - stacked(misfits(moved))) / (moved.values[i] - at.values[i]);
    }
    return slopes.colPivHouseholderQr().solve(residual);
  }

  Crane base_;
  std::vector<Comparison> parts_;
};

/// Two causes on one drive show only while that drive is asked to move.
bool may_show(const SafeMotion& motion, const Candidate& a, const Candidate& b) {
  if (a.axis != b.axis || (a.axis != "trolley" && a.axis != "slew")) return true;
  const plant::Axis axis = plant::drive_axis(a.axis);
  return std::any_of(motion.references.begin(), motion.references.end(),
                     [axis](const TimedExcitation& part) { return part.reference.axis == axis; });
}

/// How far `other`, refitted, stays from what `truth` gives, in the column that shows it most, in standard
/// deviations of the noise. Nothing when the motion is not safe for that crane.
std::optional<double> separation_of(const runtime::Rig& rig, const SafeMotion& motion,
                                    const Hypothesis& truth, Hypothesis other,
                                    const Disturbances& disturbances) {
  Crane base{rig.plant, rig.terms};
  base.parameters.load_mass_kg = motion.load_mass_kg;
  Crane crane = base;
  crane.terms.push_back(truth.candidate->setting(truth.values));
  const auto run = safe_run(rig, crane, motion);
  if (!run) return std::nullopt;
  Rival rival(base, *run, disturbances, *truth.candidate, *other.candidate);
  rival.refit(other);
  const auto left = rival.misfits(other),
             own = rival.misfits(truth);  // the replay of smoothed data errs a little
  double most = 0;
  for (std::size_t part = 0; part < left.size(); ++part)
    for (Index i = 0; i < left[part].cols(); ++i) {
      const double more = left[part].col(i).squaredNorm() - own[part].col(i).squaredNorm();
      most = std::max(most, std::sqrt(static_cast<double>(kEvery) * std::max(0.0, more)));
    }
  return most;
}

}  // namespace

std::optional<NextExperiment> propose_experiment(const runtime::Rig& rig, const Candidate& a,
                                                 const std::vector<double>& values_a, const Candidate& b,
                                                 const std::vector<double>& values_b,
                                                 const Disturbances& disturbances) {
  const auto menu = motion_menu(rig);
  std::vector<double> separations(menu.size(), 0.0);
  const Hypothesis first{&a, values_a}, second{&b, values_b};
  parallel_for(menu.size(), [&](std::size_t i) {
    if (!may_show(menu[i], a, b)) return;
    const auto one = separation_of(rig, menu[i], first, second, disturbances);
    const auto other = one ? separation_of(rig, menu[i], second, first, disturbances) : std::nullopt;
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
