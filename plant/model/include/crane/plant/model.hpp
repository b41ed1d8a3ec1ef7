#pragma once
/// The crane with its drives and terms: volts in, accelerations out.
///   F_x = M K_mx (V_x - f_x),  T_gamma = J_o K_mgamma (V_gamma - f_gamma)      (2.10), (2.26), (2.27), (3.4)
///   L'' = (K_h (V_h - f_h) - L') / tau_h                                       speed-controlled hoist
/// with f the friction in volts that the drive terms add up to.
#include <memory>
#include <vector>

#include "crane/plant/equations.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/plant/state.hpp"
#include "crane/plant/term.hpp"

namespace crane::plant {

/// What acts on the crane besides its own motion; constant between two events of the rig.
struct Actuation {
  PerAxis drive_v{};  ///< amplifier output, after the command terms [V]
  /// Braking effort on a moving axis: N, N m, and for the hoist m/s2 that replace its drive's acceleration.
  PerAxis brake_effort{};
  Locks locks;
};

class Model {
 public:
  /// @throws std::invalid_argument naming every problem of the parameters and of the terms
  explicit Model(const Parameters& parameters, const std::vector<TermSetting>& terms = {});

  [[nodiscard]] const Parameters& parameters() const noexcept { return parameters_; }

  /// What the amplifiers really give for a command; once a tick, because command terms may remember.
  [[nodiscard]] PerAxis drive_voltage(const PerAxis& command_v) noexcept;

  /// Friction in volts that the drive terms add up to.
  [[nodiscard]] PerAxis friction_v(const State& state) const noexcept;

  /// @pre as plant::accelerations
  [[nodiscard]] Accelerations accelerations(const State& state, const Actuation& actuation) const noexcept;

 private:
  Parameters parameters_;
  std::vector<std::unique_ptr<Term>> command_terms_;
  std::vector<std::unique_ptr<Term>> drive_terms_;
  std::vector<std::unique_ptr<Term>> load_terms_;
};

}  // namespace crane::plant
