#pragma once
/// Length of the pendulum and offset of the swing angles, from the equations of the swing over 2N ticks. With
/// D2 the second difference over N ticks and < > the mean with the corresponding triangular weight:
///   radial      L (D2 phi + <theta> D2 gamma + <2 gamma' theta' - phi gamma'^2>)
///                 = D2 x - <x gamma'^2> - g <sin phi> + g o_r
///   tangential  L (D2 theta - <phi> D2 gamma - <2 gamma' phi' + theta gamma'^2>)
///                 = -x D2 gamma - <2 x' gamma'> - g <sin theta> + g o_t
/// Kalman filter of (true - measured cable length, o_r, o_t). A steady wind has the same effect as an offset.
#include <Eigen/Core>

#include "crane/control/adaptation.hpp"

namespace crane::control::adaptation {

class LoadEstimate {
 public:
  explicit LoadEstimate(const Design& design);
  void reset() noexcept { filled_ = 0; }
  /// @pre consecutive ticks since reset()
  void step(const Measurement& measured) noexcept;
  [[nodiscard]] Estimated length_m() const noexcept;
  [[nodiscard]] Estimated offset_rad(std::size_t plane) const noexcept;

 private:
  static constexpr int kSpan = 10;  ///< N, ticks: 0.1 s of a swing of 2 s
  static constexpr int kSamples = 2 * kSpan + 1;
  struct Sample {
    std::array<double, 2> swing_rad{}, sine{}, position{};
    double trolley_m = 0, cable_m = 1;
  };
  void evaluate() noexcept;
  void update(std::size_t plane, double curvature, double known) noexcept;
  [[nodiscard]] const Sample& back(int ticks) const noexcept;

  double gravity_mps2_, period_s_, measured_m_;
  std::array<Sample, kSamples> samples_{};
  int filled_ = 0, newest_ = 0, due_ = 0;
  std::array<int, 2> refused_{};
  Eigen::Vector3d estimate_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  std::array<double, 2> scatter_{};
  std::array<double, 2> reading_{};  ///< variance of a reading of the swing, rad^2
};

}  // namespace crane::control::adaptation
