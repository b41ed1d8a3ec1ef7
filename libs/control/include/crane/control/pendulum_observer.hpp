#pragma once
/// Pendulum observer: predicts the state of the crane for the time when the command of this tick acts (one
/// tick ahead) from positions, swing encoder angles and applied volts. It replaces differentiators and
/// low-pass filters as the input of the laws (Design::swing_observer).
///
/// Prediction: the nonlinear equations of the tower (plant/equations.hpp) with the nominal parameters, the
/// compensated share of the friction, and three kinds of unknowns that the measurements correct:
///   d  unexplained volts of each drive: error of friction and gain
///   e  cable angle at which an unknown horizontal force F on the load (wind) holds the load, F / (m g);
///      decays with a time constant of 20 s
///   o  angle of the swing encoder at a vertical cable; constant
/// Correction: a filter with three equal poles per drive, a Kalman filter of (phi, phi', e, o) per swing
/// plane:
///   phi'' = (equations) + (g/L) e,   measured = phi + o
/// A constant force and an encoder offset have the same effect (g/L)(e + o) and cannot be distinguished. This
/// observer attributes the constant part to the offset and slow changes to the force.
#include <Eigen/Core>

#include "crane/control/law.hpp"
#include "crane/plant/state.hpp"

namespace crane::control {

/// Unknowns of one swing plane.
struct SwingUnknowns {
  double force_rad = 0;   ///< e
  double offset_rad = 0;  ///< o
};

struct CraneEstimate {
  plant::State state;  ///< one tick ahead of the measurement; swing angles without the encoder offset
  SwingUnknowns radial, tangential;
  std::array<double, 2> unexplained_v{};  ///< d of trolley and slew
};

class PendulumObserver {
 public:
  /// @pre problems(design).empty()
  explicit PendulumObserver(const Design& design);
  /// Clears the memory. The crane is at rest at `measured`; the load may swing.
  void reset(const Measurement& measured) noexcept;
  /// Updates the estimate by one tick; allocates no memory. A measurement that is not finite changes nothing.
  const CraneEstimate& step(const Measurement& measured) noexcept;

 private:
  using Matrix4 = Eigen::Matrix4d;
  struct Plane {
    Matrix4 covariance = Matrix4::Zero();
    SwingUnknowns unknowns;
  };
  void correct(const Measurement& measured) noexcept;
  void correct(Plane& plane, double& angle, double& rate, double measured) const noexcept;
  void predict(const Measurement& measured) noexcept;
  void predict(Plane& plane) const noexcept;

  Design design_;
  CraneEstimate estimate_;
  Plane radial_, tangential_;
  bool started_ = false;
};

/// Predicted measurement at the time when the command acts. The swing angles are phi - e and theta - e: wind
/// does not displace the crane.
[[nodiscard]] Measurement predicted_measurement(const CraneEstimate& estimate) noexcept;

/// Wraps the law in a pendulum observer. Returns a law that already has an observer unchanged.
[[nodiscard]] std::unique_ptr<Law> with_observer(std::unique_ptr<Law> law, const Design& design);
/// The law of `controller`, behind a pendulum observer when design.swing_observer is true.
[[nodiscard]] std::unique_ptr<Law> tracking_law(const Controller& controller, const Design& design);
[[nodiscard]] std::unique_ptr<Law> anti_swing_law(const Controller& controller, const Design& design);

}  // namespace crane::control
