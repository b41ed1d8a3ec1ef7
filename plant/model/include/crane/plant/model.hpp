#pragma once
/// Model of the crane with its drives and terms. Inputs: voltages and brakes; outputs: accelerations.
/// Source: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
///   F_x = M K_mx (V_x - f_x),  T_gamma = J_o K_mgamma (V_gamma - f_gamma)      (2.10), (2.26), (2.27), (3.4)
///   L'' = (K_h (V_h - f_h) - L') / tau_h                                       speed-controlled hoist
/// f is the friction in volts, the sum over the drive terms.
#include <memory>
#include <vector>

#include "crane/plant/equations.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/plant/state.hpp"
#include "crane/plant/term.hpp"

namespace crane::plant {

/// Inner coordinates of all structure terms of a model, their accelerations and their equations; the first
/// Model::inner_coordinates() elements are used.
using InnerState = std::array<Inner, kMostInner>;
using InnerAccelerations = std::array<double, kMostInner>;
using InnerEquations = std::array<InnerEquation, kMostInner>;

/// Inputs of the model; constant between two events of the rig.
struct Actuation {
  PerAxis drive_v{};  ///< output of the amplifiers, after the command terms [V]
  /// Braking force on the moving trolley [N], braking torque on the moving slew axis [N m]. Hoist:
  /// acceleration [m/s2] that replaces the acceleration of the drive.
  PerAxis brake_effort{};
  Locks locks;
  std::array<bool, kMostInner>
      prescribed{};  ///< true: the acceleration of this inner coordinate is prescribed
};

/// The equations of motion of a model at one state, with the friction of its drives.
struct ModelEquations {
  MotionEquations motion;
  InnerEquations inner{};
};

class Model {
 public:
  /// @param period_s  sampling period, during which a command is constant, > 0
  /// @throws std::invalid_argument with all problems of the parameters and of the terms
  explicit Model(const Parameters& parameters, const std::vector<TermSetting>& terms = {},
                 double period_s = 0.01);

  /// Parameters of the rig file, changed by the parameter terms.
  [[nodiscard]] const Parameters& parameters() const noexcept { return parameters_; }

  /// Changes the random forces on the load. A simulation calls this once per tick; a prediction does not, so
  /// that its random forces keep their initial values.
  void begin_tick() noexcept;
  /// Output of the amplifiers for a command [V]. Call once per tick: command terms may have a memory.
  [[nodiscard]] PerAxis drive_voltage(const PerAxis& command_v) noexcept;

  /// Friction of the drives, the sum over the drive terms minus Term::relieve_friction [V].
  /// @param drive_v  output of the amplifiers [V]: friction in a gear grows with the force that the
  ///   gear transmits
  [[nodiscard]] PerAxis friction_v(const State& state, const PerAxis& drive_v) const noexcept;
  [[nodiscard]] double friction_v(const State& state, double drive_v, Axis axis) const noexcept;
  /// As friction_v(), but 0 V for a locked axis.
  [[nodiscard]] PerAxis free_drives_friction_v(const State& state, const Actuation& actuation) const noexcept;

  /// Decrease of the accelerations of trolley and slew per volt of friction [m/s2 per V, rad/s2 per V]:
  /// [accelerated axis][axis with friction].
  [[nodiscard]] std::array<PerAxis, kAxes> friction_response(const State& state, const Locks& locks,
                                                             const InnerState& inner) const noexcept;

  /// Number of inner coordinates of all structure terms, at most kMostInner.
  [[nodiscard]] std::size_t inner_coordinates() const noexcept { return inner_coordinates_; }
  /// Indices of the inner coordinates that oscillate freely (Term::rings).
  [[nodiscard]] std::vector<std::size_t> ringing_coordinates() const;

  /// @param inner                inner coordinates; the first inner_coordinates() elements are used
  /// @param inner_accelerations  output; the first inner_coordinates() elements are set
  /// @pre as plant::accelerations
  [[nodiscard]] Accelerations accelerations(const State& state, const Actuation& actuation,
                                            const InnerState& inner,
                                            InnerAccelerations& inner_accelerations) const noexcept;
  /// Accelerations with the given friction [V] instead of the friction of the drive terms.
  [[nodiscard]] Accelerations accelerations(const State& state, const Actuation& actuation,
                                            const PerAxis& friction_v, const InnerState& inner,
                                            InnerAccelerations& inner_accelerations) const noexcept;
  /// For an integrator that needs the accelerations in one state for several frictions: equations()
  /// once, then solution() for each friction. The result equals that of accelerations().
  [[nodiscard]] ModelEquations equations(const State& state, const Actuation& actuation,
                                         const PerAxis& friction_v, const InnerState& inner) const noexcept;
  [[nodiscard]] Accelerations solution(const ModelEquations& equations, const Actuation& actuation,
                                       InnerAccelerations& inner_accelerations) const noexcept;
  /// Adds friction [V] of trolley and slew.
  void add_friction(const PerAxis& friction_v, ModelEquations& equations) const noexcept;
  /// Accelerations of a model without inner coordinates, or with inner coordinates at rest at 0.
  [[nodiscard]] Accelerations accelerations(const State& state, const Actuation& actuation) const noexcept;

  /// Corrects the inner coordinates along a measured motion (Term::correct).
  /// @param unexplained  measured minus modelled change of each motor's speed between two samples, m/s, rad/s
  void correct(const State& state, const PerAxis& unexplained, const InnerState& before,
               InnerState& inner) const noexcept;

  /// Term::remembers_motion of any sensor term.
  [[nodiscard]] bool sensors_remember_motion() const noexcept;
  /// Output of the sensors. Call once per tick: sensor terms may have a memory.
  [[nodiscard]] Measurement measure(const State& state) noexcept;

 private:
  struct Structure {
    std::unique_ptr<Term> term;
    std::size_t first = 0;  ///< index of the first inner coordinate of the term
  };
  void add_structure(std::unique_ptr<Term> term);
  /// The state at the suspension point of the load.
  [[nodiscard]] State displaced(const State& state, const InnerState& inner) const noexcept;
  /// Forces of drives, brakes and load terms. @param cable  as for Term::add_force()
  [[nodiscard]] Forces forces(const State& seen, const motion::Angles<double>& cable,
                              const Actuation& actuation, const PerAxis& friction_v) const noexcept;
  [[nodiscard]] double hoisting_mps2(const State& state, const Actuation& actuation,
                                     const PerAxis& friction_v) const noexcept;

  Parameters parameters_;
  double period_s_;
  std::size_t inner_coordinates_ = 0;
  Displacement rest_displacement_;
  std::vector<std::unique_ptr<Term>> command_terms_;
  std::array<std::vector<std::unique_ptr<Term>>, kAxes> drive_terms_;  ///< by the axis they act on
  std::array<bool, kAxes> has_gear_friction_{};                        ///< any of the drive terms has it
  std::vector<std::unique_ptr<Term>> load_terms_;
  std::vector<Structure> structure_terms_;
  std::vector<std::unique_ptr<Term>> sensor_terms_;
};

}  // namespace crane::plant
