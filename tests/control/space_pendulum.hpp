#pragma once
/// The load as a point mass on a massless cable, in the inertial frame: a derivation of the swing that is
/// independent of swing angles and of a rotating frame:
///   r = P + L n, |n| = 1   =>   n'' = (b - (b n) n) / L - 2 L'/L n' - |n'|^2 n,   b = (0, 0, -g) - P''
/// P is the suspension point (x cos gamma, x sin gamma, 0).
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "crane/control/law.hpp"

namespace crane::control::test {

class SpacePendulum {
 public:
  /// Hangs at rest. @param cable_ratio  length of this cable / length of the reference
  explicit SpacePendulum(double cable_ratio = 1) : ratio_{cable_ratio} {}

  /// Advances by one tick from reference `a` to reference `b`, with constant acceleration of each axis.
  void step(const Reference& a, const Reference& b, double period_s) {
    constexpr int kParts = 4;
    const double h = period_s / kParts;
    for (int i = 0; i < kParts; ++i) {
      const auto rate = [&](double time_s, const Vector6& s) { return rate_at(a, b, period_s, time_s, s); };
      const double t = i * h;
      const Vector6 k1 = rate(t, state_), k2 = rate(t + h / 2, state_ + h / 2 * k1),
                    k3 = rate(t + h / 2, state_ + h / 2 * k2), k4 = rate(t + h, state_ + h * k3);
      state_ += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      state_.head<3>().normalize();
    }
    cable_m_ = ratio_ * b[kHoist].position;
    slew_rad_ = b[kSlew].position;
  }

  [[nodiscard]] double radial_rad() const { return std::atan2(-in_jib().x(), -in_jib().z()); }
  [[nodiscard]] double tangential_rad() const { return std::asin(in_jib().y()); }
  /// Angle between cable and vertical.
  [[nodiscard]] double swing_rad() const { return std::acos(std::clamp(-state_[2], -1.0, 1.0)); }
  /// Amplitude of the swing that the present energy of the load causes when the crane is at rest.
  [[nodiscard]] double residual_rad() const {
    const double share = state_.tail<3>().squaredNorm() * cable_m_ / (2 * kGravity) + 1 + state_[2];
    return std::acos(std::clamp(1 - share, -1.0, 1.0));
  }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  static constexpr double kGravity = 9.81;

  [[nodiscard]] Eigen::Vector3d in_jib() const {
    return Eigen::AngleAxisd(-slew_rad_, Eigen::Vector3d::UnitZ()) * state_.head<3>();
  }
  [[nodiscard]] Vector6 rate_at(const Reference& a, const Reference& b, double period_s, double time_s,
                                const Vector6& state) const {
    const auto acceleration = [&](std::size_t i) { return (b[i].speed - a[i].speed) / period_s; };
    const auto speed = [&](std::size_t i) { return a[i].speed + acceleration(i) * time_s; };
    const auto position = [&](std::size_t i) {
      return a[i].position + a[i].speed * time_s + acceleration(i) * time_s * time_s / 2;
    };
    const double x = position(kTrolley), gamma = position(kSlew), rate = speed(kSlew);
    const Eigen::Vector3d along{std::cos(gamma), std::sin(gamma), 0}, across{-along.y(), along.x(), 0};
    const Eigen::Vector3d p2 = (acceleration(kTrolley) - x * rate * rate) * along +
                               (x * acceleration(kSlew) + 2 * speed(kTrolley) * rate) * across;
    const Eigen::Vector3d n = state.head<3>(), n1 = state.tail<3>();
    const Eigen::Vector3d pull = Eigen::Vector3d{0, 0, -kGravity} - p2;
    const double cable_m = ratio_ * position(kHoist), cable_mps = ratio_ * speed(kHoist);
    Vector6 result;
    result << n1, (pull - pull.dot(n) * n) / cable_m - 2 * cable_mps / cable_m * n1 - n1.squaredNorm() * n;
    return result;
  }

  double ratio_, cable_m_ = 1, slew_rad_ = 0;
  Vector6 state_{0, 0, -1, 0, 0, 0};
};

}  // namespace crane::control::test
