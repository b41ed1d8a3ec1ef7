#include "tuning/windowed_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "crane/identification/friction.hpp"

namespace crane::tuning {
namespace {

using diagnosis::PreparedRun;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 25, kMostHalvings = 8;
constexpr double kConverged = 1e-7;         // relative decrease of the loss
constexpr double kInitialStateStep = 1e-5;  // m, rad, m/s, rad/s: step of the difference quotient
constexpr double kWorstCondition = 1e12;    // largest condition number of the normalised normal matrix

struct Window {
  std::size_t run = 0, first = 0, rows = 0;
  std::vector<double> initial_state;
};

class Fitter {
 public:
  Fitter(const std::vector<PreparedRun>& runs, const WindowedFit& fit) : runs_{runs}, fit_{fit} {
    for (std::size_t i = 0; i < runs.size(); ++i) cut(i);
    if (windows_.empty()) throw identification::IdentificationError("the motion is shorter than one window");
  }

  FitResult solve(const std::vector<FitParameter>& parameters) {
    std::vector<double> values;
    for (const auto& parameter : parameters) values.push_back(parameter.value);
    auto now = linearise(values, parameters);
    for (int step = 0; step < kMostSteps; ++step) {
      auto next = improved(now, values, parameters);
      if (!next) break;
      const bool converged = now.loss - next->loss < kConverged * now.loss;
      now = std::move(*next);
      if (converged) break;
    }
    return result(now, values);
  }

  double residual_rms(const std::vector<FitParameter>& parameters) {
    std::vector<double> values;
    for (const auto& parameter : parameters) values.push_back(parameter.value);
    const auto linear = linearise(values, parameters);
    std::vector<bool> is_free(values.size(), true);
    is_free[0] = false;
    const VectorXd step = solved(linear, is_free);
    double loss = 0;
    Eigen::Index rows = 0;
    for (std::size_t w = 0; w < linear.residual.size(); ++w) {
      loss += (linear.residual[w] - linear.slope[w] * step).squaredNorm();
      rows += linear.residual[w].size();
    }
    return std::sqrt(loss / static_cast<double>(rows));
  }

 private:
  struct Linear {
    std::vector<VectorXd> residual;  ///< projected, by window
    std::vector<MatrixXd> slope;
    double loss = 0;
    MatrixXd normal;
    VectorXd gradient;
  };

  void cut(std::size_t run) {
    const auto& data = runs_[run].run;
    const auto rows = static_cast<std::size_t>(std::llround(fit_.window_s / data.period_s));
    const auto begin = static_cast<std::size_t>(std::llround(fit_.begin_s / data.period_s));
    for (std::size_t first = begin; first + rows <= data.rows(); first += rows)
      windows_.push_back({run, first, rows, {}});
  }

  /// Measured minus replayed values of the compared outputs.
  VectorXd residual_of(const diagnosis::Replay& replay, const Window& window,
                       const std::vector<double>& initial_state) const {
    const auto simulated = diagnosis::simulated_outputs(runs_[window.run], fit_.part);
    std::vector<double> out(simulated.size() * window.rows);
    replay.run(fit_.part, window.first, window.rows, initial_state, out);
    VectorXd residual{static_cast<Eigen::Index>(fit_.outputs.size() * window.rows)};
    Eigen::Index at = 0;
    for (const auto output : fit_.outputs) {
      const auto place = static_cast<std::size_t>(std::ranges::find(simulated, output) - simulated.begin());
      for (std::size_t k = 0; k < window.rows; ++k)
        residual[at++] =
            runs_[window.run].run.measured[output][window.first + k] - out[place * window.rows + k];
    }
    return residual;
  }

  /// The replays of all runs for values of the parameters.
  struct Trial {
    std::vector<PreparedRun> runs;  ///< runs with the amplifier outputs as commands; empty: the measured runs
    diagnosis::Replays replays;
    const diagnosis::Replay& operator[](std::size_t run) const { return replays[run]; }
  };

  [[nodiscard]] Trial trial(const std::vector<double>& values) const {
    Trial trial;
    const auto crane = fit_.crane(values);
    if (fit_.amplifiers) trial.runs = runs_;
    for (auto& run : trial.runs) run.run.command_v = fit_.amplifiers(values, run.run.command_v);
    for (const auto& run : fit_.amplifiers ? trial.runs : runs_) trial.replays.emplace_back(run, crane);
    return trial;
  }

  Linear linearise(const std::vector<double>& values, const std::vector<FitParameter>& parameters) {
    const auto base = trial(values);
    for (auto& window : windows_)
      if (window.initial_state.empty())
        window.initial_state = base[window.run].measured_start(fit_.part, window.first);
    std::vector<Trial> stepped;
    std::vector<double> steps;
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      auto changed = values;
      const double step =
          values[p] + parameters[p].step <= parameters[p].high ? parameters[p].step : -parameters[p].step;
      changed[p] += step;
      steps.push_back(step);
      stepped.push_back(trial(changed));
    }
    Linear linear;
    const auto count = static_cast<Eigen::Index>(parameters.size());
    linear.normal = MatrixXd::Zero(count, count);
    linear.gradient = VectorXd::Zero(count);
    for (const auto& window : windows_) {
      const VectorXd residual = residual_of(base[window.run], window, window.initial_state);
      MatrixXd slope{residual.size(), count};
      for (Eigen::Index p = 0; p < count; ++p) {
        const auto i = static_cast<std::size_t>(p);
        slope.col(p) =
            (residual - residual_of(stepped[i][window.run], window, window.initial_state)) / steps[i];
      }
      add(linear, residual, slope, initial_state_slopes(base[window.run], window, residual));
    }
    return linear;
  }

  MatrixXd initial_state_slopes(const diagnosis::Replay& replay, const Window& window,
                                const VectorXd& residual) {
    MatrixXd slopes{residual.size(), static_cast<Eigen::Index>(window.initial_state.size())};
    for (std::size_t i = 0; i < window.initial_state.size(); ++i) {
      auto changed = window.initial_state;
      changed[i] += kInitialStateStep;
      slopes.col(static_cast<Eigen::Index>(i)) =
          (residual - residual_of(replay, window, changed)) / kInitialStateStep;
    }
    return slopes;
  }

  static void add(Linear& linear, const VectorXd& residual, const MatrixXd& slope,
                  const MatrixXd& initial_state) {
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> of_initial_state{initial_state};
    linear.residual.emplace_back(residual - initial_state * of_initial_state.solve(residual));
    linear.slope.emplace_back(slope - initial_state * of_initial_state.solve(slope));
    linear.loss += linear.residual.back().squaredNorm();
    linear.normal += linear.slope.back().transpose() * linear.slope.back();
    linear.gradient += linear.slope.back().transpose() * linear.residual.back();
  }

  /// Solves the normal equations with normalised columns. The step is 0 in directions without information.
  static VectorXd solved(const Linear& linear, const std::vector<bool>& is_free) {
    const VectorXd scale = linear.normal.diagonal().cwiseSqrt().cwiseMax(1e-300);
    MatrixXd normal = scale.cwiseInverse().asDiagonal() * linear.normal * scale.cwiseInverse().asDiagonal();
    VectorXd gradient = linear.gradient.cwiseQuotient(scale);
    for (std::size_t i = 0; i < is_free.size(); ++i) {
      if (is_free[i]) continue;
      const auto p = static_cast<Eigen::Index>(i);
      normal.row(p).setZero();
      normal.col(p).setZero();
      normal(p, p) = 1;
      gradient[p] = 0;
    }
    return normal.completeOrthogonalDecomposition().solve(gradient).cwiseQuotient(scale);
  }

  /// One step; `values` change when it succeeds.
  std::optional<Linear> improved(const Linear& now, std::vector<double>& values,
                                 const std::vector<FitParameter>& parameters) {
    std::vector<bool> is_free(values.size(), true);
    VectorXd step = solved(now, is_free);
    for (std::size_t i = 0; i < values.size(); ++i) {  // a parameter at its bound that wants to leave is held
      const double wanted = step[static_cast<Eigen::Index>(i)];
      if ((values[i] <= parameters[i].low && wanted < 0) || (values[i] >= parameters[i].high && wanted > 0))
        is_free[i] = false;
    }
    step = solved(now, is_free);
    double share = 1;
    for (int i = 0; i < kMostHalvings; ++i, share /= 2) {
      auto tried = values;
      for (std::size_t p = 0; p < values.size(); ++p)
        tried[p] = std::clamp(values[p] + share * step[static_cast<Eigen::Index>(p)], parameters[p].low,
                              parameters[p].high);
      auto next = linearise(tried, parameters);
      if (!(next.loss < now.loss)) continue;
      values = tried;
      return next;
    }
    return std::nullopt;
  }

  FitResult result(const Linear& now, const std::vector<double>& values) const {
    FitResult result{.values = values, .standard_errors = {}, .residual_rms = 0, .windows = windows_.size()};
    const VectorXd scale = now.normal.diagonal().cwiseSqrt().cwiseMax(1e-300);
    const MatrixXd normal =
        scale.cwiseInverse().asDiagonal() * now.normal * scale.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen{normal};
    if (!(eigen.eigenvalues().minCoeff() * kWorstCondition > eigen.eigenvalues().maxCoeff()))
      throw identification::IdentificationError("the motion does not determine all parameters");
    MatrixXd meat = MatrixXd::Zero(normal.rows(), normal.cols());
    Eigen::Index rows = 0;
    for (std::size_t w = 0; w < now.residual.size(); ++w) {
      const VectorXd g = (now.slope[w].transpose() * now.residual[w]).cwiseQuotient(scale);
      meat += g * g.transpose();
      rows += now.residual[w].size();
    }
    const MatrixXd inverse = normal.inverse();
    const auto count = static_cast<double>(windows_.size());
    const double factor = count / std::max(1.0, count - static_cast<double>(values.size()));
    const MatrixXd covariance = factor * inverse * meat * inverse;
    for (Eigen::Index p = 0; p < normal.rows(); ++p)
      result.standard_errors.push_back(std::sqrt(std::max(0.0, covariance(p, p))) / scale[p]);
    result.residual_rms = std::sqrt(now.loss / static_cast<double>(rows));
    return result;
  }

  const std::vector<PreparedRun>& runs_;
  const WindowedFit& fit_;
  std::vector<Window> windows_;
};

}  // namespace

double residual_rms(const std::vector<PreparedRun>& runs, const WindowedFit& fit,
                    const std::vector<FitParameter>& parameters) {
  return Fitter{runs, fit}.residual_rms(parameters);
}

FitResult fit_windows(const std::vector<PreparedRun>& runs, const WindowedFit& fit,
                      const std::vector<FitParameter>& parameters) {
  return Fitter{runs, fit}.solve(parameters);
}

}  // namespace crane::tuning
