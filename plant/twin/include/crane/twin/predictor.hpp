#pragma once
/// Predicts tick k from tick k-1 and the voltages between them, and corrects the state with the measurement
/// (observer with the time constant T, the horizon). With rho = exp(-h / T), h the period and e = measured -
/// predicted:
///   position += (1 - rho^2) e,   rate += (1 - rho)^2 / h e
/// Both poles of the error are rho: errors decay with the time constant T. A constant error a of the
/// acceleration gives e -> a T^2.
#include <memory>
#include <optional>
#include <vector>

#include "crane/plant/model.hpp"
#include "crane/stepper/step_integrator.hpp"
#include "crane/twin/columns.hpp"

namespace crane::twin {

/// Measured values of one tick.
struct MeasuredTick {
  PerColumn reported{}, rate{};  ///< m or rad; m/s or rad/s
  double cable_m = 1, cable_mps = 0;
};

class Predictor {
 public:
  /// @param slip  error of an encoder per path length, m/m or rad/rad
  /// @throws std::invalid_argument when the model rejects the terms
  Predictor(const plant::Parameters& parameters, const std::vector<plant::TermSetting>& terms,
            double period_s, double horizon_s, const PerColumn& slip = {});
  /// Restarts at the measured state. @param simulated  columns that are predicted; the other columns are held
  void restart(const MeasuredTick& now, const Mask& simulated);
  /// Predicts the sensor values one tick after the last restart() or predict(). `applied_v` acts during this
  /// tick.
  /// @pre restart() was called
  const PerColumn& predict(const plant::PerAxis& applied_v, const MeasuredTick& now);
  /// Corrects the state with the measured values of the predicted tick.
  void correct(const PerColumn& reported);
  [[nodiscard]] const PerColumn& predicted() const { return predicted_; }

 private:
  [[nodiscard]] std::array<stepper::Kinematics, kColumns> given(const MeasuredTick& now) const;

  std::unique_ptr<plant::Model> model_;
  std::optional<stepper::StepIntegrator> integrator_;
  PerColumn slip_;
  Mask simulated_{};
  MeasuredTick before_;
  PerColumn predicted_{};
  double position_gain_, rate_gain_;
  int steps_;
  double step_s_;
};

}  // namespace crane::twin
