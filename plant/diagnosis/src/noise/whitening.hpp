#pragma once
/// What sensor noise and an unknown force do to the residual of a window, and the transform that makes that
/// white. The residual x of one output follows
///   x'' = -w^2 x - c x' + a,   seen as x + noise,
/// with a an acceleration of first-order colour; w is 0 for a drive, c 0 for a pendulum. An axis that sticks
/// forgets the error of its speed; where it moves slowly, when exactly it breaks loose and comes to rest no
/// friction law knows: white acceleration there. White are the innovations of the Kalman filter of this, in
/// units of their standard deviation (Kalman, J. Basic Eng. 82 (1960) 35). The numbers are found by maximum
/// likelihood from the residuals themselves.
#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace crane::diagnosis {

struct Disturbance {
  double noise = 0;          ///< standard deviation of the sensor, m or rad
  double acceleration = 0;   ///< of a, m/s2 or rad/s2
  double correlation_s = 0;  ///< correlation time of a; 0: white
  double damping_ps = 0;     ///< c, 1/s
  double friction = 0;       ///< standard deviation of the white acceleration at standstill, m/s2 or rad/s2
  bool sticks = false;
  double misfit =
      0;  ///< minus twice the log likelihood of the residuals it was learnt from, but for a constant
};

/// An axis that turns or comes to rest has forgotten what error its speed had; one that stands has none.
enum class Going { on, turning, standing };

/// How an axis moved, by row of a window.
struct Pace {
  double slow = 0;  ///< 0 at speed to 1 at standstill
  Going going = Going::on;
  bool seen = true;  ///< whether the row was measured
};
using Paces = std::vector<Pace>;

/// A window of one output: how long, how it moved.
struct Passage {
  double period_s = 0, natural_radps = 0;  ///< natural: of a pendulum; 0: a drive
  Paces paces;                             ///< by row
};

/// @param residuals of windows, all of one output; lengths may differ
/// @param passages one for each of them
/// @param least_noise of the sensor, m or rad
/// @param near where to begin, if something is known
[[nodiscard]] Disturbance learn(const std::vector<Eigen::VectorXd>& residuals,
                                const std::vector<Passage>& passages, double least_noise,
                                const Disturbance& near = {});

class Whitener {
 public:
  Whitener(const Disturbance& disturbance, const Passage& passage);
  /// W x with W^T W the inverse covariance of the residual, to each column of x.
  void apply(Eigen::Ref<Eigen::MatrixXd> x) const;
  /// Of the innovation of a row; 0 where nothing was measured.
  [[nodiscard]] double log_variance(std::size_t row) const {
    return rows_[row].inverse_sd > 0 ? -2 * std::log(rows_[row].inverse_sd) : 0;
  }

 private:
  struct Row {
    Eigen::Vector3d gain;
    double inverse_sd = 0;
    Going going = Going::on;
  };
  Eigen::Matrix3d step_;
  std::vector<Row> rows_;
};

}  // namespace crane::diagnosis
