#pragma once
/// Force balance of trolley and slew axis between two ticks: friction in volts. With u the mean voltage, T
/// the tension of the cable and e its unit vector from the suspension point to the load,
///   f_x     = u - x''/K_mx + (M_j x gamma'^2 + T e_x) / (M K_mx)
///   f_gamma = u - gamma''/K_mg + (x T e_y - M_j x^2 gamma'' - 2 M_j x x' gamma') / (J_o K_mg)
/// T is proportional to the payload m: f = free + m * load. Accelerations are second differences of the
/// positions, u is the mean of the two voltages between them (docs/equations.md#friction-identification).
#include <array>

#include "crane/control/adaptation.hpp"

namespace crane::control::adaptation {

struct AxisBalance {
  double free_v = 0;     ///< friction of a crane without payload
  double load_vpkg = 0;  ///< added per kg of payload
  double inertia_v = 0;  ///< voltage that accelerates the drive
  double speed = 0;      ///< m/s or rad/s
};
using Balance = std::array<AxisBalance, kAdaptedAxes>;

class ForceBalance {
 public:
  explicit ForceBalance(const Design& design);
  void reset() noexcept { ticks_ = 0; }
  /// @return true when `balance()` belongs to this tick: three consecutive ticks are known
  bool step(const Measurement& measured) noexcept;
  [[nodiscard]] const Balance& balance() const noexcept { return balance_; }

 private:
  void evaluate(const Measurement& now) noexcept;

  plant::Parameters unit_load_;  ///< with a payload of 1 kg
  double period_s_;
  std::array<Measurement, 2> before_{};  ///< of the last tick and the tick before it
  int ticks_ = 0;
  Balance balance_{};
};

}  // namespace crane::control::adaptation
