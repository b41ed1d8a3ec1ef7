#pragma once
/// Continuous-discrete extended Kalman filter of one run. Commands, positions and swings are events at their
/// own times: a command delay, a sensor delay, jitter, a gap, a missing column and any rate are the same
/// code. Sources: R. E. Kalman, J. Basic Eng. 82 (1960) 35; N. R. Kristensen, H. Madsen, S. B. Jorgensen,
/// Automatica 40 (2004) 225.
#include <Eigen/Core>
#include <functional>

#include "model/crane_model.hpp"

namespace crane::innovations {

/// How a command goes from one of its rows to the next. Rows rarer than the converter's steps do not hold.
enum class Between { held, straight };

/// Force-shaped columns h_j(t, s): column j pushes coordinate[j], in the unit of its unknown force.
struct Columns {
  std::vector<std::size_t> coordinate;
  std::function<void(double time_s, const double* s, const std::array<double, 2>& volts, double* h)> evaluate;
};

/// One entry per measured value, channel after channel in the order of the run's series: the place of a value
/// does not depend on the hypothesis.
struct Innovations {
  std::vector<double> e, variance, log_likelihood, time_s;
  std::vector<unsigned char> channel;
  Eigen::MatrixXd states;       ///< filtered, a column per value; empty unless asked for
  Eigen::MatrixXd sensitivity;  ///< d prediction / d (amount of a column) / sqrt(variance), a row per value
  bool finite = true;
};

/// Where the state begins beyond what the first rows tell; of double pendulums.
struct RunStart {
  std::array<double, 2> lower_rad{}, lower_radps{};
};

struct FilterRequest {
  Between between = Between::held;
  bool keep_states = false;
  const Columns* columns = nullptr;
  RunStart start;
  /// Open loop from this state; only the motion of a drive whose command is not known is followed as
  /// measured.
  const Eigen::VectorXd* open_loop = nullptr;
};

/// Variance of a sensor's noise: r^2 + (counts and floor).
[[nodiscard]] double sensor_variance(const Values& values, const Scales& scales, const Run& run,
                                     std::size_t channel);

[[nodiscard]] Innovations filter(const CraneModel& model, const Nominal& nominal, const Scales& scales,
                                 const Run& run, const Values& values, const FilterRequest& request);

/// Sizes of states that the filter is compiled for: one coordinate or two, with or without a lower cable.
[[nodiscard]] constexpr bool has_filter(std::size_t size) {
  return size == 3 || size == 5 || size == 6 || size == 8;
}

/// log of Student's t, scaled to `variance` at its centre.
[[nodiscard]] double student_log_density(double e, double variance);

}  // namespace crane::innovations
