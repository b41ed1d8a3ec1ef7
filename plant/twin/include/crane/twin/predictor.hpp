#pragma once
/// One model beside the crane: tick k from tick k-1 and the volts that acted between, then drawn towards what
/// was measured with the memory of a horizon T. With rho = exp(-h / T) and e = reported - predicted
///   position += (1 - rho^2) e,   rate += (1 - rho)^2 / h e,
/// two equal poles at rho: what is wrong with an acceleration by a shows as e -> a T^2 and is forgotten after
/// some T, so that errors do not accumulate.
#include <memory>
#include <optional>
#include <vector>

#include "crane/diagnosis/course.hpp"
#include "crane/plant/model.hpp"
#include "crane/twin/columns.hpp"

namespace crane::twin {

/// What is known about one tick without the model.
struct Known {
  PerColumn reported{}, rate{};
  double cable_m = 1, cable_mps = 0;
};

class Predictor {
 public:
  /// @param slip what an encoder reports too much per distance travelled, both ways counted
  /// @throws std::invalid_argument for terms that do not fit together
  Predictor(const plant::Parameters& parameters, const std::vector<plant::TermSetting>& terms,
            double period_s, double horizon_s, const PerColumn& slip = {});
  /// Begins anew where the crane is. @param simulated columns that are predicted; the others stand still
  void restart(const Known& now, const Mask& simulated);
  /// What the sensors report one tick after the last restart or predict, `applied_v` acting in between.
  /// @pre restart() was called
  const PerColumn& predict(const plant::PerAxis& applied_v, const Known& now);
  void correct(const PerColumn& reported);
  [[nodiscard]] const PerColumn& predicted() const { return predicted_; }

 private:
  [[nodiscard]] std::array<diagnosis::Moment, kColumns> given(const Known& now) const;

  std::unique_ptr<plant::Model> model_;
  std::optional<diagnosis::Course> course_;
  PerColumn slip_;
  Mask simulated_{};
  Known before_;
  PerColumn predicted_{};
  double position_gain_, rate_gain_;
  int steps_;
  double step_s_;
};

}  // namespace crane::twin
