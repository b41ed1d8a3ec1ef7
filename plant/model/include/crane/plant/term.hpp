#pragma once
/// Terms: effects beyond the basic equations of motion, for example friction or wind. Each term has a name,
/// parameters and a place where it acts. Rig files activate terms. Simulator and diagnosis use the same list.
/// A term consists of one file in src/terms and one line in src/terms/registered.def.
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crane/plant/drive_motion.hpp"
#include "crane/plant/equations.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/plant/state.hpp"

namespace crane::plant {

/// Inner coordinate of a structure term, for example the deflection of the jib: second order, initially at
/// rest at 0.
struct Inner {
  double position = 0;  ///< m or rad
  double rate = 0;      ///< m/s or rad/s
};
/// Equation of motion of an inner coordinate q: q'' = free + by_trolley x'' + ... + by_cable L'', linear in
/// the accelerations of drives and swing. `free` has the unit of q''; each by_* has the unit of q''
/// divided by that of its acceleration.
struct InnerEquation {
  double free = 0;
  double by_trolley = 0, by_radial = 0, by_slew = 0, by_tangential = 0, by_cable = 0;

  [[nodiscard]] double acceleration(const Accelerations& a) const noexcept {
    return free + by_trolley * a.trolley_mps2 + by_radial * a.radial_radps2 + by_slew * a.slew_radps2 +
           by_tangential * a.tangential_radps2 + by_cable * a.cable_mps2;
  }
};
/// Maximum number of inner coordinates of a model.
inline constexpr std::size_t kMostInner = 8;

/// Position of the suspension point of the load minus the positions at the encoders of the drives.
struct Displacement {
  double trolley_m = 0, slew_rad = 0, cable_m = 0;
};

/// Output of the sensors.
struct Measurement {
  double trolley_m = 0, slew_rad = 0, cable_m = 0, radial_rad = 0, tangential_rad = 0;
};

/// One effect. A derived class overrides the functions of its `acts_on`.
class Term {
 public:
  Term() = default;
  Term(const Term&) = delete;
  Term& operator=(const Term&) = delete;
  virtual ~Term() = default;

  /// Parameter and structure terms, once at the start: changes the parameters of the rig file.
  virtual void change_parameters(Parameters& /*crane*/) const noexcept {}
  /// Command terms, once per tick in the order of the rig file: converts the input of the amplifier to its
  /// output [V], which is constant for `period_s`. May depend on earlier ticks.
  virtual void change_command(PerAxis& /*drive_v*/, double /*period_s*/) noexcept {}
  /// Drive terms: adds friction, in volts of the amplifier (F / K_m). A positive value opposes a positive
  /// speed.
  virtual void add_friction(const DriveMotion& /*drive*/, double& /*friction_v*/) const noexcept {}
  /// Drive terms: force that depends on the position only, in volts of the amplifier, positive along the
  /// axis. A term with such a force subtracts it in add_friction.
  /// @param position  of the drive [m or rad]
  [[nodiscard]] virtual double position_force_v(double /*position*/) const noexcept { return 0; }
  /// Drive terms: true if add_gear_friction() adds friction.
  [[nodiscard]] virtual bool has_gear_friction() const noexcept { return false; }
  /// Drive terms: adds friction that grows with the force in the gear.
  /// @param carried_v  |V - P| [V], V the output of the amplifier, P the sum of the forces that depend on the
  ///   position, for example a weight that the gear holds against the motor
  virtual void add_gear_friction(const DriveMotion& /*drive*/, double /*carried_v*/,
                                 double& /*friction_v*/) const noexcept {}
  /// Structure terms: subtracts the part of a drive's friction that acts beyond the structure.
  virtual void relieve_friction(const Parameters& /*crane*/, const State& /*state*/,
                                PerAxis& /*friction_v*/) const noexcept {}
  /// Load terms, once per tick: draws the next value of a random force. The force is constant within a tick.
  virtual void begin_tick(double /*period_s*/) noexcept {}
  /// Load terms: adds generalised forces of the load.
  /// @param cable  sines and cosines of the angles of the cable in the slewing frame
  virtual void add_force(const Parameters& /*crane*/, const State& /*state*/,
                         const motion::Angles<double>& /*cable*/, Forces& /*sum*/) const noexcept {}

  /// Structure terms: number of inner coordinates; 0 when the parameters make the structure rigid. The
  /// arguments `inner` and `equations` below point to the inner coordinates of this term.
  [[nodiscard]] virtual std::size_t inner_coordinates() const noexcept { return 0; }
  /// True when the inner coordinates oscillate freely, so that the inputs do not determine their state.
  [[nodiscard]] virtual bool rings() const noexcept { return inner_coordinates() > 0; }
  /// Constant displacement, added to the positions only.
  [[nodiscard]] virtual Displacement rest_displacement(const Parameters& /*crane*/) const noexcept {
    return {};
  }
  /// Adds the displacement. The displacement is linear in `inner`: the same function converts positions,
  /// rates and accelerations.
  virtual void displace(const double* /*inner*/, Displacement& /*sum*/) const noexcept {}
  /// Adds generalised forces that depend on the inner coordinates, and computes the equations of motion of
  /// the inner coordinates. @param cable as for add_force() @param equations  all coefficients are 0
  virtual void add_inner_motion(const Parameters& /*crane*/, const State& /*state*/,
                                const motion::Angles<double>& /*cable*/, const Inner* /*inner*/,
                                Forces& /*sum*/, InnerEquation* /*equations*/) const noexcept {}

  /// Corrects the inner coordinates between two samples of a measured motion.
  /// @param unexplained  measured minus modelled change of each motor's speed between the samples [m/s,
  ///   rad/s]
  /// @param before       inner coordinates at the first sample
  /// @param inner        inner coordinates at the second sample
  virtual void correct(const Parameters& /*crane*/, const State& /*state*/, const PerAxis& /*unexplained*/,
                       const Inner* /*before*/, Inner* /*inner*/) const noexcept {}

  /// Sensor terms: true when the sensor value depends on the whole motion since the start, not only on the
  /// last half second.
  [[nodiscard]] virtual bool remembers_motion() const noexcept { return false; }
  /// Sensor terms, once per tick: converts true values to sensor values. May depend on earlier ticks.
  virtual void change_measurement(Measurement& /*measured*/, double /*period_s*/) noexcept {}
};

/// Place where a term acts.
enum class ActsOn {
  parameters,  ///< parameters of the rig file
  command,     ///< voltage between command and motor
  drive,       ///< friction of a drive
  load,        ///< force on the load
  structure,   ///< position of the suspension point
  sensor       ///< measured values
};

/// One parameter of a term. A term whose parameters all have their defaults has no effect.
struct TermParameter {
  std::string_view name;
  std::string_view unit;  ///< "V s/m or V s/rad": that of trolley and hoist, or that of the slew axis
  double default_value = 0;
  double low = 0;  ///< permitted range [low, high]
  double high = 0;
  std::string_view meaning;
};

/// Description of a term for rig files, tests and docs/terms.md.
struct TermKind {
  std::string_view name;
  std::string_view equation;  ///< clauses separated by "; ". x' is the derivative of x
  std::string_view effect;    ///< the physical effect, in words
  ActsOn acts_on = ActsOn::drive;
  std::vector<std::string_view> axes;  ///< permitted values of TermSetting::axis; "": the term needs no axis
  std::vector<TermParameter> parameters;
  TermSetting example;  ///< an effect that the encoders of a laboratory crane can resolve
  /// @pre the setting has no problems and contains every parameter
  std::unique_ptr<Term> (*make)(const TermSetting& setting) = nullptr;
};

/// All terms, in the order of the documentation.
[[nodiscard]] const std::vector<TermKind>& term_kinds();
/// @return nullptr when no term has this name
[[nodiscard]] const TermKind* find_term(std::string_view name);
/// @return nullptr when the term has no parameter of this name
[[nodiscard]] const TermParameter* find_parameter(const TermKind& kind, std::string_view name);
/// @return TermParameter::unit on an axis: "V s/m or V s/rad" is one of both
[[nodiscard]] std::string_view unit_on(std::string_view axis, std::string_view unit);

/// @return all problems as "terms[2] drive_friction: name = value: rule"; empty when there are none
[[nodiscard]] std::vector<std::string> problems(const std::vector<TermSetting>& settings);

/// @return the term; missing parameters have their defaults
/// @throws std::invalid_argument with all problems of the setting
[[nodiscard]] std::unique_ptr<Term> make_term(const TermSetting& setting);

/// @return the axis of a name. @pre name is "trolley", "slew" or "hoist"
[[nodiscard]] Axis drive_axis(std::string_view name) noexcept;

}  // namespace crane::plant
