#pragma once
/// What every control law sees and gives. No DDS, no clock, no files: one call per tick of fixed length.
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "crane/plant/parameters.hpp"

namespace crane::control {

using plant::kAxes;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;
using Volts = std::array<double, kAxes>;

/// One tick of measurements in SI units; signs as in docs/equations.md.
struct Measurement {
  std::array<double, kAxes> position{};  ///< m, rad, m of cable
  std::array<double, kAxes> speed{};     ///< per second
  double swing_radial_rad = 0;           ///< phi, positive: load towards the tower
  double swing_radial_radps = 0;
  double swing_tangential_rad = 0;  ///< theta, positive: load ahead in the direction of +slew
  double swing_tangential_radps = 0;
};

struct AxisReference {
  double position = 0, speed = 0, acceleration = 0;
};
using Reference = std::array<AxisReference, kAxes>;

/// Output of one law in one tick.
struct Contribution {
  Volts drive_v{};         ///< V at the motor amplifiers
  Reference correction{};  ///< to be added to the reference by tracking
};

/// A law with its memory. step() must not allocate, throw or return a non-finite value for finite input
/// and a design without problems; input that is not finite may come out as such and is the gate's to refuse.
class Law {
 public:
  virtual ~Law() = default;
  [[nodiscard]] virtual Contribution step(const Measurement& measured,
                                          const Reference& reference) noexcept = 0;
  /// Forget the past: the crane rests as measured.
  virtual void reset(const Measurement& measured) noexcept = 0;
};

enum class ReferenceShape { step, bang_coast_bang };

/// Friction estimate of one drive in volts (b/K_m, c/K_m) and the rule that compensates it, (3.1)-(3.5).
/// Ranges: design_fields.hpp.
struct DriveFriction {
  double viscous_positive_vspm = 0;  ///< b+/K_m [V per m/s or rad/s]
  double viscous_negative_vspm = 0;  ///< b-/K_m
  double coulomb_positive_v = 0;     ///< c+/K_m
  double coulomb_negative_v = 0;
  double stiction_positive_v = 0;  ///< f_s+ at standstill
  double stiction_negative_v = 0;
  double stiction_slope_per_v = 100;  ///< A of (3.2)
  double zero_band_mps = 0.005;       ///< d_s of (3.3): |speed| below it counts as standstill
  double factor = 0;                  ///< share that is compensated: 0 off, 1 exact

  /// All problems at once as "name = value: rule"; empty when usable.
  [[nodiscard]] std::vector<std::string> problems() const;

  bool operator==(const DriveFriction&) const = default;
};

/// Everything a controller is designed from: the rig as the controller believes it to be, and the choices.
/// Ranges: design_fields.hpp.
struct Design {
  plant::Parameters crane;                       ///< nominal parameters
  double period_s = 0.01;                        ///< tick
  double cable_length_m = 1.0;                   ///< nominal; laws schedule on the measured length
  Volts volt_limit_v{10, 10, 10};                ///< |V| the drive can give
  double full_feedback_gain_pm = 4.0;            ///< largest K of the full-state feedback, V/m and V/rad
  double tracking_proportional = 100;            ///< K_p of (3.41), normalised time
  double tracking_derivative = 20;               ///< K_d = 2 sqrt(K_p), (3.42)
  double delayed_1_gain = -90;                   ///< K_del of (3.47), tower sign
  double delayed_1_delay = 0.1;                  ///< tau_del in periods of the load
  double hoist_proportional_ps = 2.0;            ///< cable position loop [1/s]
  double minimum_trolley_position_m = 0.1;       ///< guard of the 1/x gains of the slew axis
  std::array<DriveFriction, kAxes> friction;     ///< for the compensation
  double anti_swing_proportional = -30;          ///< K_ps of (3.45), normalised time, tower sign
  double anti_swing_derivative = 8;              ///< K_ds of (3.45)
  double delayed_2_gain = -0.33;                 ///< K_del of (3.50), tower sign
  double delayed_2_delay = 0.31;                 ///< tau_del in periods of the load
  double fuzzy_swing_rad = 0.17453292519943295;  ///< swing that is PB, phi_max of (3.51)
  double fuzzy_swing_rate = 1.5;                 ///< swing rate that is PB, rad per load period (3.51)
  double fuzzy_gain = -90;                       ///< K_V / phi_max of (3.51), tower sign
  double fuzzy_point_a = 1.0 / 3;                ///< peak of PS (figure 3.20)
  double fuzzy_point_b = 2.0 / 3;                ///< peak of PM
  double shortest_cable_length_m = 0.1;          ///< laws take the measured length into this range ...
  double longest_cable_length_m = 100;           ///< ... which also bounds the memory of the delayed laws

  bool operator==(const Design&) const = default;
};

/// All problems at once as "name = value: rule", those of the crane and of the friction included; empty when
/// usable. Friction is named "friction.<axis>.<name>".
[[nodiscard]] std::vector<std::string> problems(const Design& design);

/// An entry of the registry: one name a user can type.
struct Controller {
  std::string_view name;
  std::string_view summary;
  ReferenceShape reference;
  std::unique_ptr<Law> (*make_tracking)(const Design&);
  std::unique_ptr<Law> (*make_anti_swing)(const Design&);
  bool corrects_reference = false;  ///< tracking has to join the anti-swing law's correction of the same tick
};

/// What keeps `controller` from working with this design, which itself has no problems: rules that
/// fuzzy_generated could not generate. Empty for every other controller.
[[nodiscard]] std::vector<std::string> problems(const Controller& controller, const Design& design);

/// All controllers, in the order of the documentation.
[[nodiscard]] const std::vector<Controller>& controllers();
/// @return nullptr when there is none of that name
[[nodiscard]] const Controller* find_controller(std::string_view name);

}  // namespace crane::control
