#include <algorithm>
#include <cmath>
#include <numbers>

#include "crane/plant/term.hpp"
#include "terms/far_side.hpp"
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
        far_(slew_, gap_ > 0 ? s.parameters.at("driven_share") : 0) {}

  void change_parameters(Parameters& crane) const noexcept override { far_.split(crane); }
  [[nodiscard]] std::size_t inner_coordinates() const noexcept override { return gap_ > 0 ? 1 : 0; }
  /// Friction forgets where in the gap it once was.
  [[nodiscard]] bool rings() const noexcept override { return false; }
  void displace(const double* inner, Displacement& sum) const noexcept override {
    if (gap_ > 0) (slew_ ? sum.slew_rad : sum.trolley_m) += inner[0];
  }
  void add_inner_force(const Parameters& crane, const State& state, const Inner* inner,
                       Forces& sum) const noexcept override {
    far_.push_back(crane, state, contact(inner[0]), sum);
  }
  void accelerate(const Parameters& crane, const State& state, const Accelerations& drives,
                  const Inner* inner, double* acceleration) const noexcept override {
    if (gap_ == 0) return;
    const double speed = slew_ ? state.slew_radps : state.trolley_mps;  // of the suspended side
    const double motor = slew_ ? drives.slew_radps2 : drives.trolley_mps2;
    acceleration[0] = far_.acceleration(crane, state, contact(inner[0])) -
                      guide_deceleration_ * smooth_sign(speed, kGuideSmoothing) - motor;
    // The jib's turning throws a trolley outward, which the motor holds only where a flank touches.
    if (!slew_) acceleration[0] += state.trolley_m * state.slew_radps * state.slew_radps;
  }
  /// The motor has been struck: what it gained the suspended side lost, which stands at the flank on that
  /// side. Or it has not been where the flanks met: there they still stand.
  void correct(const Parameters& crane, const State& state, const PerAxis& unexplained, const Inner* before,
               Inner* inner) const noexcept override {
    const double change = unexplained[slew_ ? kSlew : kTrolley];
    if (!far_.carries() || change == 0) return;
    const double side = std::copysign(1.0, change), flank = 0.5 * gap_;
    const bool met = std::max(-side * before[0].position, -side * inner[0].position) > flank;
    inner[0].position = side * (met ? -flank : std::max(side * inner[0].position, flank));
    const double fastest = gap_ * contact_radps_;  // a lighter side would be thrown to and fro by noise
    inner[0].rate = std::clamp(inner[0].rate - far_.passed_on(crane, state, change), -fastest, fastest);
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
  double contact_radps_, gap_, guide_deceleration_;
  FarSide far_;
};

}  // namespace

TermKind backlash() {
  return {
      .name = "backlash",
      .equation =
          "the load hangs at p + b, b'' = (j J k + P - C) / (j J + M_j x2) - a tanh((p' + b')/v_s) + Z - "
          "p''; "
          "contact k is 0 for |b| < h/2 and a damped spring of 25 Hz (trolley) or 15 Hz (jib) beyond; "
          "M_j x2 and C = 2 M_j x x' slew' of a jib only, Z = (x + b) slew'^2 of a trolley only; the motor "
          "moves "
          "(1 - j) J and feels -(j J k + P)",
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
