#pragma once
/// Terms: effects the bare equations do not have, each with a name, parameters and a place where it acts. A
/// rig file switches them on; simulator and diagnosis share the list. A term is one file in src/terms and one
/// line in src/terms/registered.def.
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crane/plant/equations.hpp"
#include "crane/plant/parameters.hpp"
#include "crane/plant/state.hpp"

namespace crane::plant {

/// A coordinate of a term's own, second order, at rest at zero when the rig starts.
struct Inner {
  double position = 0;
  double rate = 0;
};
/// All terms of a model together have at most so many.
inline constexpr std::size_t kMostInner = 8;

/// Where the load hangs from, against what the drives' encoders see.
struct Displacement {
  double trolley_m = 0, slew_rad = 0, cable_m = 0;
};

/// What the sensors report.
struct Measurement {
  double trolley_m = 0, slew_rad = 0, cable_m = 0, radial_rad = 0, tangential_rad = 0;
};

/// One effect. A kind overrides the functions that belong to its `acts_on`.
class Term {
 public:
  Term() = default;
  Term(const Term&) = delete;
  Term& operator=(const Term&) = delete;
  virtual ~Term() = default;

  /// Parameter and structure terms, once: the crane is another than the rig file says.
  virtual void change_parameters(Parameters& /*crane*/) const noexcept {}
  /// Command terms, once a tick and in the order of the rig file: turns the amplifier's input into its output
  /// [V], held for `period_s`. May remember earlier ticks.
  virtual void change_command(PerAxis& /*drive_v*/, double /*period_s*/) noexcept {}
  /// Drive terms: adds the friction the drive meets, in volts of its amplifier (F / K_m); positive opposes
  /// +speed.
  virtual void add_friction(const State& /*state*/, PerAxis& /*friction_v*/) const noexcept {}
  /// Load terms: adds generalised forces.
  virtual void add_force(const Parameters& /*crane*/, const State& /*state*/,
                         Forces& /*sum*/) const noexcept {}

  /// Structure terms may have coordinates of their own, none when the parameters make them rigid; `inner` and
  /// `acceleration` below are theirs.
  [[nodiscard]] virtual std::size_t inner_coordinates() const noexcept { return 0; }
  /// They ring on by themselves: what drives them does not tell where they are.
  [[nodiscard]] virtual bool rings() const noexcept { return inner_coordinates() > 0; }
  /// Displacement that is always there; of the position only.
  [[nodiscard]] virtual Displacement rest_displacement(const Parameters& /*crane*/) const noexcept {
    return {};
  }
  /// Adds the displacement, for positions, rates and accelerations alike: linear in `inner`.
  virtual void displace(const double* /*inner*/, Displacement& /*sum*/) const noexcept {}
  /// Adds generalised forces that depend on the own coordinates.
  virtual void add_inner_force(const Parameters& /*crane*/, const State& /*state*/, const Inner* /*inner*/,
                               Forces& /*sum*/) const noexcept {}
  /// Accelerations of the own coordinates, given those of the drives and the swing. Called again when a
  /// displacement of any term has changed the swing's.
  virtual void accelerate(const Parameters& /*crane*/, const State& /*state*/,
                          const Accelerations& /*drives*/, const Inner* /*inner*/,
                          double* /*acceleration*/) const noexcept {}

  /// From one sample of a measured motion to the next a motor's speed has changed by so much more than the
  /// model makes of it [m/s, rad/s]: what that says about where the own coordinates are now.
  /// @param before where they were at the first of the samples
  virtual void correct(const Parameters& /*crane*/, const State& /*state*/, const PerAxis& /*unexplained*/,
                       const Inner* /*before*/, Inner* /*inner*/) const noexcept {}

  /// Sensor terms, once a tick: turns what is into what is reported. May remember earlier ticks.
  virtual void change_measurement(Measurement& /*measured*/, double /*period_s*/) noexcept {}
};

enum class ActsOn { parameters, command, drive, load, structure, sensor };

/// One number of a term. The default of all of them together has no effect.
struct TermParameter {
  std::string_view name;
  std::string_view unit;
  double default_value = 0;
  double low = 0;  ///< allowed range, both ends included
  double high = 0;
  std::string_view meaning;
};

/// What may be written in a rig file.
struct TermKind {
  std::string_view name;
  std::string_view equation;
  std::string_view source;
  ActsOn acts_on = ActsOn::drive;
  std::vector<std::string_view> axes;  ///< allowed TermSetting::axis; "" stands for an empty one
  std::vector<TermParameter> parameters;
  /// @pre the setting has no problems and names every parameter
  std::unique_ptr<Term> (*make)(const TermSetting& setting) = nullptr;
};

/// All terms, in the order of the documentation.
[[nodiscard]] const std::vector<TermKind>& term_kinds();
/// @return nullptr when there is none of that name
[[nodiscard]] const TermKind* find_term(std::string_view name);

/// All problems at once as "terms[2] drive_friction: name = value: rule"; empty when usable.
[[nodiscard]] std::vector<std::string> problems(const std::vector<TermSetting>& settings);

/// @return the term, parameters left out taking their defaults
/// @throws std::invalid_argument naming every problem of the setting
[[nodiscard]] std::unique_ptr<Term> make_term(const TermSetting& setting);

/// "trolley", "slew", "hoist" to the axis. @pre it is one of them
[[nodiscard]] Axis drive_axis(std::string_view name) noexcept;

}  // namespace crane::plant
