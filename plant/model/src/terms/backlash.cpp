#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane/plant/term.hpp"
#include "terms/smooth_sign.hpp"

namespace crane::plant {
namespace {

/// Contact of the flanks: a spring with the suspended side's inertia, of 25 Hz in a nut and 15 Hz in the gear
/// of a jib, never pulling, from which steel comes back with almost half its speed. The damping sets in over
/// the first part of the depth, so that the force is continuous.
constexpr double kNut_radps = 2 * std::numbers::pi * 25, kGear_radps = 2 * std::numbers::pi * 15;
constexpr double kContactDampingRatio = 0.25;
constexpr double kSoftShare = 0.02;  // of the gap: depth of full damping
/// Guide friction changes its direction over this speed [m/s or rad/s]: an explicit step of 2.5 ms stays
/// stable.
constexpr double kGuideSmoothing = 0.003;

class Backlash final : public Term {
 public:
  explicit Backlash(const TermSetting& s)
      : slew_(s.axis == "slew"),
        contact_radps_(slew_ ? kGear_radps : kNut_radps),
        gap_(s.parameters.at("gap")),
        guide_deceleration_(s.parameters.at("guide_deceleration")),
        driven_share_(gap_ > 0 ? s.parameters.at("driven_share") : 0) {}

  /// The motor moves what is before the gap; its force stays what it was.
  void change_parameters(Parameters& crane) const noexcept override {
    (slew_ ? crane.jib_inertia_kgm2 : crane.trolley_inertia_kg) *= 1 - driven_share_;
    (slew_ ? crane.slew_gain_radps2pv : crane.trolley_gain_mps2pv) /= 1 - driven_share_;
  }

  [[nodiscard]] std::size_t inner_coordinates() const noexcept override { return gap_ > 0 ? 1 : 0; }
  /// Friction forgets where in the gap it once was.
  [[nodiscard]] bool rings() const noexcept override { return false; }
  void displace(const double* inner, Displacement& sum) const noexcept override {
    if (gap_ > 0) (slew_ ? sum.slew_rad : sum.trolley_m) += inner[0];
  }
  /// The contact pushes back on the motor, and the load pulls at what is behind the gap, not at the motor.
  void add_inner_force(const Parameters& crane, const State& state, const Inner* inner,
                       Forces& sum) const noexcept override {
    if (driven_share_ == 0) return;
    (slew_ ? sum.slew_nm : sum.trolley_n) -= driven_inertia(crane) * contact(inner[0]) + pull(crane, state);
  }
  void accelerate(const Parameters& crane, const State& state, const Accelerations& drives,
                  const Inner* inner, double* acceleration) const noexcept override {
    if (gap_ == 0) return;
    const double speed = slew_ ? state.slew_radps : state.trolley_mps;  // of the suspended side
    const double motor = slew_ ? drives.slew_radps2 : drives.trolley_mps2;
    acceleration[0] = contact(inner[0]) - guide_deceleration_ * smooth_sign(speed, kGuideSmoothing) - motor;
    // The jib's turning throws a trolley outward, which the motor holds only where a flank touches.
    if (!slew_) acceleration[0] += state.trolley_m * state.slew_radps * state.slew_radps;
    if (driven_share_ > 0) acceleration[0] += pull(crane, state) / driven_inertia(crane);
  }

 private:
  [[nodiscard]] double driven_inertia(const Parameters& crane) const {
    return driven_share_ / (1 - driven_share_) * (slew_ ? crane.jib_inertia_kgm2 : crane.trolley_inertia_kg);
  }
  /// Of a load that hangs at rest, N or N m.
  [[nodiscard]] double pull(const Parameters& crane, const State& state) const {
    const double ct = std::cos(state.tangential_rad), cf = std::cos(state.radial_rad);
    const double tension_n = crane.load_mass_kg * crane.gravity_mps2 * ct * cf;
    return slew_ ? tension_n * std::sin(state.tangential_rad) * state.trolley_m
                 : -tension_n * ct * std::sin(state.radial_rad);
  }
  [[nodiscard]] double contact(const Inner& inner) const {
    const double depth = std::abs(inner.position) - 0.5 * gap_;
    if (depth <= 0) return 0;
    const double side = std::copysign(1.0, inner.position);
    const double damping =
        2 * kContactDampingRatio * contact_radps_ * std::min(1.0, depth / (kSoftShare * gap_));
    return -side * std::max(0.0, contact_radps_ * contact_radps_ * depth + damping * side * inner.rate);
  }
  bool slew_;
  double contact_radps_, gap_, guide_deceleration_, driven_share_;
};

}  // namespace

TermKind backlash() {
  return {
      .name = "backlash",
      .equation =
          "the load hangs at p + b, b'' = k - a tanh((p' + b')/v_s) + P/(j J) + Z - p''; contact k is 0 for "
          "|b| < h/2 and a damped spring of 25 Hz (trolley) or 15 Hz (jib) beyond; Z = (x + b) slew'^2 of a "
          "trolley, 0 of a jib; the "
          "motor moves (1 - j) J and feels -j J k",
      .source = "play of nut or gear between motor, which has the encoder, and trolley or jib",
      .acts_on = ActsOn::structure,
      .axes = {"trolley", "slew"},
      .parameters = {{"gap", "m or rad", 0, 0, 0.1, "h, free travel from flank to flank"},
                     {"guide_deceleration", "m/s2 or rad/s2", 1, 0, 2,
                      "a, what friction takes from the suspended side while no flank touches"},
                     {"driven_share", "1", 0, 0, 0.9,
                      "j, share of the axis's inertia J behind the gap, which the load pulls at with P"}},
      .make = [](const TermSetting& s) -> std::unique_ptr<Term> { return std::make_unique<Backlash>(s); }};
}

}  // namespace crane::plant
