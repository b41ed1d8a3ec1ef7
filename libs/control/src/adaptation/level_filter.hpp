#pragma once
/// Kalman filter of the Coulomb and viscous levels of both directions of both axes, of the payload m, and of
/// the error r of the inertia per volt of each axis. One scalar update per block of ticks with motion in one
/// direction:
///   d free = c + b |v| - m d load + r d inertia,   d = 1 for positive motion, -1 for negative
/// Directional forgetting: only the levels in the regressor of a block take a random walk.
#include <Eigen/Core>

#include "crane/control/adaptation.hpp"

namespace crane::control::adaptation {

/// Means over one block, multiplied by the sign of the motion.
struct Block {
  double free_v = 0, load_vpkg = 0, inertia_v = 0, speed = 0;
};

class LevelFilter {
 public:
  /// (c, b) of axis 0 positive, axis 0 negative, axis 1 positive, axis 1 negative; m; r of both axes.
  static constexpr int kStates = 11;
  explicit LevelFilter(const Design& design);

  struct Innovation {
    double value_v = 0, deviation_v = 0;  ///< deviation: expected standard deviation
    bool plausible = true;
  };
  /// Measured minus estimated friction of a block.
  [[nodiscard]] Innovation innovation(std::size_t axis, std::size_t direction,
                                      const Block& block) const noexcept;
  void update(std::size_t axis, std::size_t direction, const Block& block) noexcept;
  /// Resets the covariance of a direction to that of the rig file; the estimates do not change.
  void forget(std::size_t axis, std::size_t direction) noexcept;
  /// Resets the levels of a direction and their covariance to those of the rig file.
  void restart(std::size_t axis, std::size_t direction) noexcept;
  /// Call at the end of a move: the payload may have changed.
  void loosen_payload() noexcept;

  /// Friction of a block with the estimated payload and inertia.
  [[nodiscard]] double friction_v(std::size_t axis, const Block& block) const noexcept;
  /// Friction at a speed, c + b |v|.
  [[nodiscard]] Estimated moving_v(std::size_t axis, std::size_t direction, double speed) const noexcept;
  /// Standard deviation of a block beyond that of the estimates.
  [[nodiscard]] double scatter_v(std::size_t axis) const noexcept;
  /// Part of scatter_v() above the least scatter: noise of the encoder.
  [[nodiscard]] double noise_v(std::size_t axis) const noexcept;
  [[nodiscard]] Estimated coulomb_v(std::size_t axis, std::size_t direction) const noexcept;
  [[nodiscard]] Estimated viscous_vspm(std::size_t axis, std::size_t direction) const noexcept;
  /// True when the estimate of the payload is at its bound: then the filter attributes force of the load to
  /// the friction, or the reverse. False for a crane without payload.
  [[nodiscard]] bool payload_at_bound() const noexcept;
  [[nodiscard]] Estimated load_mass_kg() const noexcept { return at(kMass); }
  [[nodiscard]] double prior_coulomb_deviation(std::size_t axis, std::size_t direction) const noexcept {
    return prior_[index(axis, direction)];
  }

 private:
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;
  static constexpr int kMass = 8, kInertia = 9;
  [[nodiscard]] static int index(std::size_t axis, std::size_t direction) noexcept {
    return static_cast<int>(4 * axis + 2 * direction);
  }
  [[nodiscard]] Estimated at(int i) const noexcept;
  [[nodiscard]] static Vector regressor(std::size_t axis, std::size_t direction, const Block& block) noexcept;

  Vector nominal_ = Vector::Zero(), prior_ = Vector::Zero(), share_ = Vector::Zero();
  Vector estimate_ = Vector::Zero();
  Matrix covariance_ = Matrix::Zero();
  std::array<double, kAdaptedAxes> scatter_{};  ///< variance of a block, V^2
};

}  // namespace crane::control::adaptation
