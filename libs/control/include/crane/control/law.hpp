#pragma once
/// Interface, inputs and outputs of a control law. A law uses no DDS, no clock and no files. The component
/// of the law calls step() once per tick; the period is constant.
/// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
/// Signs: docs/equations.md#coordinates-and-signs.
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crane/control/adaptation_settings.hpp"
#include "crane/plant/parameters.hpp"

namespace crane::control {

using plant::kAxes;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;
using Volts = std::array<double, kAxes>;

/// Measurements of one tick, in SI units.
struct Measurement {
  std::array<double, kAxes> position{};  ///< m, rad, m of cable
  std::array<double, kAxes> speed{};     ///< m/s, rad/s, m/s of cable
  double swing_radial_rad = 0;           ///< phi, positive: load towards the tower
  double swing_radial_radps = 0;
  double swing_tangential_rad = 0;  ///< theta, positive: load ahead in the direction of +slew
  double swing_tangential_radps = 0;
  Volts applied_v{};  ///< V, acts from this tick to the next
};

/// Reference of one axis: m, rad or m of cable, with its first and second derivative with respect to time in
/// seconds.
struct AxisReference {
  double position = 0, speed = 0, acceleration = 0;
  double start = 0;  ///< measured position of the axis when `position` last changed (reference_start.hpp)
};

/// Planned swing of the load (signs of Measurement).
struct SwingReference {
  double radial_rad = 0, radial_radps = 0, tangential_rad = 0, tangential_radps = 0;
};

/// Reference of all axes, indexed by axis. A time-optimal plan and the stick also state swing and volts of
/// the planned motion at the time when the command of the tick acts; in other references both are 0.
struct Reference : std::array<AxisReference, kAxes> {
  SwingReference swing;
  Volts feed_forward_v{};  ///< V, without the compensation of friction
};

/// Output of one law in one tick.
struct Contribution {
  Volts drive_v{};         ///< V at the input of the motor amplifiers
  Reference correction{};  ///< added to the reference of tracking (only with Controller::corrects_reference)
};

/// A law with its memory.
/// docs/adding_a_law.md#the-rules-of-a-law lists the rules of step() and reset().
/// tests/control/law_test.cpp checks these rules.
class Law {
 public:
  virtual ~Law() = default;
  [[nodiscard]] virtual Contribution step(const Measurement& measured,
                                          const Reference& reference) noexcept = 0;
  /// Clears the memory. Afterwards the law behaves as if the crane had always been at rest at `measured`.
  virtual void reset(const Measurement& measured) noexcept = 0;
};

/// Shape of the reference of trolley and slew.
enum class ReferenceShape {
  step,             ///< the reference jumps to the target
  bang_coast_bang,  ///< constant acceleration, constant speed, constant deceleration
  zv,               ///< bang_coast_bang through the input shaper ZV (shaper.hpp)
  zvd,              ///< the same through ZVD
  ei,               ///< the same through EI
  time_optimal      ///< plan of time_optimal.hpp, or bang_coast_bang through zv when there is none
};

/// Friction estimate of one drive in volts (b/K_m, c/K_m) for the compensation (3.1)-(3.5).
/// Ranges: design_fields.hpp.
struct DriveFriction {
  double viscous_positive_vspm = 0;   ///< b+/K_m, V per m/s or V per rad/s
  double viscous_negative_vspm = 0;   ///< b-/K_m, same unit
  double coulomb_positive_v = 0;      ///< c+/K_m, V
  double coulomb_negative_v = 0;      ///< c-/K_m, V
  double stiction_positive_v = 0;     ///< f_s+ at standstill, V
  double stiction_negative_v = 0;     ///< f_s- at standstill, V
  double stiction_slope_per_v = 100;  ///< A of (3.2), 1/V
  double zero_band_mps = 0.005;       ///< d_s of (3.3), m/s or rad/s: a smaller |speed| counts as standstill
  double factor = 0;                  ///< compensated share of the friction; 0: off, 1: all

  /// @return all problems as "name = value: rule"; empty when there are none
  [[nodiscard]] std::vector<std::string> problems() const;

  bool operator==(const DriveFriction&) const = default;
};

/// Nominal crane and parameters of all controllers. "Normalised" gains use the load period T as unit of time.
/// Ranges: design_fields.hpp.
struct Design {
  plant::Parameters crane;         ///< nominal parameters
  double period_s = 0.01;          ///< sampling period
  double cable_length_m = 1.0;     ///< nominal length; the laws use the measured length
  Volts volt_limit_v{10, 10, 10};  ///< largest |V| of the drives
  /// Largest forward gain K of the full-state feedback (3.26): V/m on the trolley, V/rad on the slew axis.
  double full_state_forward_gain_vpm = 4.0;
  double tracking_proportional = 100;            ///< K_p of (3.41), normalised
  double tracking_derivative = 20;               ///< K_d of (3.41), normalised; 2 sqrt(K_p) by (3.42)
  double delayed_1_gain = -90;                   ///< K_del of (3.47), normalised
  double delayed_1_delay = 0.1;                  ///< tau_del, load periods
  double hoist_proportional_ps = 2.0;            ///< gain of the cable position loop, 1/s
  double minimum_trolley_position_m = 0.1;       ///< limits the 1/x gains of the slew axis (schedule.hpp)
  std::array<DriveFriction, kAxes> friction;     ///< for the friction compensation
  double anti_swing_proportional = -30;          ///< K_ps of (3.45), normalised
  double anti_swing_derivative = 8;              ///< K_ds of (3.45), normalised
  double delayed_2_gain = -0.33;                 ///< K_del of (3.50)
  double delayed_2_delay = 0.31;                 ///< tau_del, load periods
  double fuzzy_swing_rad = 0.17453292519943295;  ///< phi_max of (3.51): swing with full membership in PB
  double fuzzy_swing_rate = 1.5;         ///< rate with full membership in PB (3.51), rad per load period
  double fuzzy_gain = -90;               ///< K_V / phi_max of (3.51)
  double fuzzy_point_a = 1.0 / 3;        ///< peak of PS (figure 3.20)
  double fuzzy_point_b = 2.0 / 3;        ///< peak of PM
  double shortest_cable_length_m = 0.1;  ///< lower limit of the measured length in the laws
  double longest_cable_length_m = 100;   ///< upper limit; determines the memory of the delayed laws
  bool swing_observer = false;           ///< the laws use the estimate of pendulum_observer.hpp
  AdaptationSettings adaptation;         ///< of the friction compensation

  bool operator==(const Design&) const = default;
};

/// @return all problems as "name = value: rule", including those of crane and friction; empty when there are
///   none. Friction has names of the form "friction.<axis>.<name>"
[[nodiscard]] std::vector<std::string> problems(const Design& design);

/// An entry of the registry: the two laws that users select by one name.
struct Controller {
  std::string_view name;
  std::string_view summary;
  ReferenceShape reference;
  std::unique_ptr<Law> (*make_tracking)(const Design&);
  std::unique_ptr<Law> (*make_anti_swing)(const Design&);
  bool corrects_reference = false;  ///< true: tracking needs the anti-swing law's correction of the same tick
};

/// @return problems of `controller` with this design: rules that fuzzy_generated could not generate; empty
///   for every other controller. @pre problems(design).empty()
[[nodiscard]] std::vector<std::string> problems(const Controller& controller, const Design& design);

/// All controllers, in the order of the documentation.
[[nodiscard]] const std::vector<Controller>& controllers();
/// @return nullptr when no controller has this name
[[nodiscard]] const Controller* find_controller(std::string_view name);

}  // namespace crane::control
