#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane/plant/smooth_sign.hpp"
#include "crane/plant/term.hpp"
#include "terms/far_side.hpp"

namespace crane::plant {
namespace {

/// Natural frequency of the contact between the flanks, with the inertia of the load side: 25 Hz for the
/// nut of a trolley, 15 Hz for the gear of a jib. The contact is a damped spring without tension; the
/// coefficient of restitution is almost one half. The damping increases with the depth of contact up to
/// kSoftShare, so that the force is continuous.
constexpr double kNut_radps = 2 * std::numbers::pi * 25, kGear_radps = 2 * std::numbers::pi * 15;
constexpr double kContactDampingRatio = 0.25;
constexpr double kSoftShare = 0.02;  // depth of full damping, as a share of the gap
/// Width of the step of the guide friction at speed 0 [m/s or rad/s]. An explicit integrator with steps of
/// 2.5 ms is stable with this value.
constexpr double kGuideSmoothing = 0.003;

class Backlash final : public Term {
 public:
  explicit Backlash(const TermSetting& s)
      : slew_(s.axis == "slew"),
        contact_radps_(slew_ ? kGear_radps : kNut_radps),
        gap_(s.parameters.at("gap")),
        guide_deceleration_(s.parameters.at("guide_deceleration")),
        known_share_(s.parameters.at("known_guide_share")),
        smoothing_speed_(s.parameters.at("smoothing_speed")),
        far_(slew_, gap_ > 0 ? s.parameters.at("driven_share") : 0) {}

  void change_parameters(Parameters& crane) const noexcept override { far_.split(crane); }
  /// The friction of the rig file is that of the whole axis. Subtracts the part of the guide from the
  /// friction of the motor.
  void relieve_friction(const Parameters& crane, const State& state,
                        PerAxis& friction_v) const noexcept override {
    if (!far_.carries() || known_share_ == 0) return;
    const Axis axis = slew_ ? kSlew : kTrolley;
    friction_v[axis] -= known_share_ * far_.own_inertia(crane) * guide_deceleration_ /
                        far_.motor_force(crane) * smooth_sign(speed(state, axis), smoothing_speed_);
  }
  [[nodiscard]] std::size_t inner_coordinates() const noexcept override { return gap_ > 0 ? 1 : 0; }
  /// The guide friction damps the motion in the gap: the initial position has no lasting effect.
  [[nodiscard]] bool rings() const noexcept override { return false; }
  void displace(const double* inner, Displacement& sum) const noexcept override {
    if (gap_ > 0) (slew_ ? sum.slew_rad : sum.trolley_m) += inner[0];
  }
  void add_inner_motion(const Parameters& crane, const State& state, const motion::Angles<double>& cable,
                        const Inner* inner, Forces& sum, InnerEquation* equations) const noexcept override {
    if (gap_ == 0) return;
    const double flanks = contact(inner[0]), load_force = far_.load_force(crane, state, cable);
    far_.add_motor_reaction(crane, flanks, load_force, sum);
    const double speed = slew_ ? state.slew_radps : state.trolley_mps;  // of the load side
    const double guide = guide_deceleration_ * smooth_sign(speed, kGuideSmoothing);
    InnerEquation& far = equations[0];
    far.free = far_.acceleration(crane, state, flanks - guide, load_force);
    (slew_ ? far.by_slew : far.by_trolley) = -1;
    // Centrifugal acceleration of the trolley. The force acts on the motor only while a flank touches.
    const double c = crane.tilt_cosine;
    if (!slew_) far.free += c * c * state.trolley_m * state.slew_radps * state.slew_radps;
  }
  /// An unexplained change of the motor's speed is an impact of the flanks. The load side has lost the
  /// momentum that the motor has gained, and is at the flank that transmitted it. When the model predicted an
  /// impact that was not measured, the flanks remain in contact.
  void correct(const Parameters& crane, const State& state, const PerAxis& unexplained, const Inner* before,
               Inner* inner) const noexcept override {
    const double change = unexplained[slew_ ? kSlew : kTrolley];
    if (!far_.carries() || change == 0) return;
    const double side = std::copysign(1.0, change), flank = 0.5 * gap_;
    const bool met = std::max(-side * before[0].position, -side * inner[0].position) > flank;
    inner[0].position = side * (met ? -flank : std::max(side * inner[0].position, flank));
    // limits the effect of measurement noise for a light load side
    const double fastest = gap_ * contact_radps_;
    inner[0].rate = std::clamp(inner[0].rate - far_.speed_loss(crane, state, change), -fastest, fastest);
  }

 private:
  [[nodiscard]] double contact(const Inner& inner) const {
    const double depth = std::abs(inner.position) - 0.5 * gap_;
    if (depth <= 0) return 0;
    const double side = std::copysign(1.0, inner.position);
    const double damping =
        2 * kContactDampingRatio * contact_radps_ * std::min(1.0, depth / (kSoftShare * gap_));
    return -side * std::max(0.0, contact_radps_ * contact_radps_ * depth + damping * side * inner.rate);
  }
  bool slew_;
  double contact_radps_, gap_, guide_deceleration_, known_share_, smoothing_speed_;
  FarSide far_;
};

}  // namespace

TermKind backlash() {
  return {
      .name = "backlash",
      .equation =
          "suspension point at p + b, b'' = (j J (k - a tanh((p' + b')/v_s)) + P - C) / (j J + M_j x^2) + Z "
          "- "
          "p'', v_s = 0.003 m/s or rad/s; contact k = 0 for |b| < h/2, otherwise a damped spring of 25 Hz "
          "(trolley) or 15 Hz (jib); "
          "M_j x^2 and C = 2 M_j x x' slew' for a jib only, Z = (x + b) slew'^2 for a trolley only; inertia "
          "of the motor (1 - j) J, force on the motor -(j J k + P), friction of the motor smaller by r j a / "
          "K",
      .effect =
          "the nut of the trolley or the gear of the jib has play; the encoder measures the motor, not the "
          "trolley "
          "or the jib",
      .acts_on = ActsOn::structure,
      .axes = {"trolley", "slew"},
      .parameters =
          {{"gap", "m or rad", 0, 0, 0.1, "h, distance that the load side moves from one flank to the other"},
           {"guide_deceleration", "m/s2 or rad/s2", 1, 0, 2,
            "a, deceleration of the inertia j J by the friction of the guide; it acts with and "
            "without contact"},
           {"driven_share", "1", 0, 0, 0.9,
            "j, inertia on the load side of the gap / inertia J of the axis; 0: the load side has "
            "no inertia, the "
            "motor accelerates J"},
           {"known_guide_share", "1", 0, 0, 1,
            "r, share of the guide's friction j J a that the friction of the rig file contains: the "
            "friction of the motor is smaller by this share"},
           {"smoothing_speed", "m/s or rad/s", 0.0005, 1e-6, 0.1,
            "width of the step of the friction r j a / K of the motor at v = 0; not v_s of the guide"}},
      .example = {"backlash", "trolley", {{"gap", 0.004}}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<Backlash>(s); }};
}

}  // namespace crane::plant
