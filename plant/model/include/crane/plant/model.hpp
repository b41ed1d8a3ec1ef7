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

/// Accelerations of a term's own coordinates, in the order of Model's inner coordinates.
using InnerState = std::array<Inner, kMostInner>;
using InnerAccelerations = std::array<double, kMostInner>;

/// What acts on the crane besides its own motion; constant between two events of the rig.
struct Actuation {
  PerAxis drive_v{};  ///< amplifier output, after the command terms [V]
  /// Braking effort on a moving axis: N, N m, and for the hoist m/s2 that replace its drive's acceleration.
  PerAxis brake_effort{};
  Locks locks;
  std::array<bool, kMostInner> led{};  ///< own coordinates of terms whose accelerations are given
};

class Model {
 public:
  /// @param period_s tick: how long a command is held, > 0
  /// @throws std::invalid_argument naming every problem of the parameters and of the terms
  explicit Model(const Parameters& parameters, const std::vector<TermSetting>& terms = {},
                 double period_s = 0.01);

  /// Those of the rig file, changed by the parameter terms.
  [[nodiscard]] const Parameters& parameters() const noexcept { return parameters_; }

  /// What the amplifiers really give for a command; once a tick, because command terms may remember.
  [[nodiscard]] PerAxis drive_voltage(const PerAxis& command_v) noexcept;

  /// Friction in volts that the drive terms add up to.
  [[nodiscard]] PerAxis friction_v(const State& state) const noexcept;
  [[nodiscard]] double friction_v(const State& state, Axis axis) const noexcept;

  /// What a volt of friction takes from the accelerations of trolley and slew: [accelerated][rubbing axis].
  [[nodiscard]] std::array<PerAxis, kAxes> friction_response(const State& state, const Locks& locks,
                                                             const InnerState& inner) const noexcept;

  /// Number of coordinates the structure terms have of their own, at most kMostInner.
  [[nodiscard]] std::size_t inner_coordinates() const noexcept { return inner_coordinates_; }
  /// Those of them that ring on by themselves (Term::rings), by index.
  [[nodiscard]] std::vector<std::size_t> ringing_coordinates() const;

  /// @param inner own coordinates of the structure terms; the first inner_coordinates() count
  /// @param inner_accelerations filled likewise
  /// @pre as plant::accelerations
  [[nodiscard]] Accelerations accelerations(const State& state, const Actuation& actuation,
                                            const InnerState& inner,
                                            InnerAccelerations& inner_accelerations) const noexcept;
  /// The same with friction given [V] instead of that of the drive terms.
  [[nodiscard]] Accelerations accelerations(const State& state, const Actuation& actuation,
                                            const PerAxis& friction_v, const InnerState& inner,
                                            InnerAccelerations& inner_accelerations) const noexcept;
  /// For a model without inner coordinates, or with them at rest.
  [[nodiscard]] Accelerations accelerations(const State& state, const Actuation& actuation) const noexcept;

  /// Terms' own coordinates along a measured motion, by what the model has not made of the motors' speed from
  /// one sample to the next (Term::correct).
  void correct(const State& state, const PerAxis& unexplained, const InnerState& before,
               InnerState& inner) const noexcept;

  /// What the sensors report; once a tick, because sensor terms may remember.
  [[nodiscard]] Measurement measure(const State& state) noexcept;

 private:
  struct Structure {
    std::unique_ptr<Term> term;
    std::size_t first = 0;  ///< index of its first inner coordinate
  };
  void add_structure(std::unique_ptr<Term> term);
  [[nodiscard]] State displaced(const State& state, const InnerState& inner) const noexcept;
  [[nodiscard]] Forces forces(const State& seen, const Actuation& actuation, const PerAxis& friction_v,
                              const InnerState& inner) const noexcept;

  Parameters parameters_;
  double period_s_;
  std::size_t inner_coordinates_ = 0;
  Displacement rest_displacement_;
  std::vector<std::unique_ptr<Term>> command_terms_;
  std::array<std::vector<std::unique_ptr<Term>>, kAxes> drive_terms_;  ///< by the axis they act on
  std::vector<std::unique_ptr<Term>> load_terms_;
  std::vector<Structure> structure_terms_;
  std::vector<std::unique_ptr<Term>> sensor_terms_;
};

}  // namespace crane::plant
