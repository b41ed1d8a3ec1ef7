/// Linear-quadratic regulator of the decoupled load, scheduled exactly over cable length and trolley
/// position.
///
/// The tracking law cancels the force of the load on the drives (3.37), (3.38), so that each plane is a
/// pendulum on a support whose acceleration a is the control. With lengths in L, accelerations in g and time
/// in sqrt(L/g), every plane and every cable length has the same equations,
///   p'' = a,   s'' = a - s
/// p: distance of the support from its reference; s: swing (phi, or -theta). The gains of
///   a = -(k_p p + k_v p' + k_s s + k_r s')
/// minimise the integral of (p - s)^2 + w a^2, the squared distance of the load from its reference and the
/// effort. With a plan, its feed-forward volts are added, and p and s are distances from the planned state.
/// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes.
#include <Eigen/Dense>
#include <cmath>

#include "crane/control/hoist.hpp"
#include "crane/control/pendulum_observer.hpp"
#include "crane/control/schedule.hpp"
#include "crane/plant/pendulum.hpp"

namespace crane::control {
namespace {

struct LqrGains {
  double position, speed, swing, swing_rate;
};

// w. A smaller value gives a faster law with more volts and less tolerance to errors of the cable length.
constexpr double kEffortWeight = 1;
// w for the distance from a plan. With 0.05, maneuver 2 settles in 2.22 s instead of 2.37 s, but the loop is
// unstable with a cable 20 % shorter than measured.
constexpr double kPlanEffortWeight = 0.18;

/// Riccati equation A'P + PA - P b b' P / w + q q' = 0 by integration of its differential equation to the
/// steady state.
LqrGains lqr_gains(double effort_weight) {
  Eigen::Matrix4d a;
  a << 0, 1, 0, 0,  //
      0, 0, 0, 0,   //
      0, 0, 0, 1,   //
      0, 0, -1, 0;
  const Eigen::Vector4d b{0, 1, 0, 1}, load{1, 0, -1, 0};
  constexpr double kRiccatiStep = 4e-3;
  constexpr int kRiccatiSteps = 10000;  // 40 units of time; the slowest closed-loop mode needs less than 5
  Eigen::Matrix4d p = Eigen::Matrix4d::Zero();
  for (int i = 0; i < kRiccatiSteps; ++i) {
    const Eigen::Vector4d pb = p * b;
    p += kRiccatiStep *
         (a.transpose() * p + p * a - pb * pb.transpose() / effort_weight + load * load.transpose());
  }
  const Eigen::Vector4d k = p * b / effort_weight;
  return {k[0], k[1], k[2], k[3]};
}

/// Gains of one tick in SI units: acceleration of the support per m, m/s, rad, rad/s.
LqrGains at_length(const LqrGains& k, double gravity_mps2, double length_m) noexcept {
  const double rate_radps = plant::swing_radps(gravity_mps2, length_m);
  return {k.position * rate_radps * rate_radps, k.speed * rate_radps, k.swing * gravity_mps2,
          k.swing_rate * gravity_mps2 / rate_radps};
}

/// Volts per acceleration of the suspension point, along the jib and across it.
struct VoltsPerAcceleration {
  VoltsPerAcceleration(const Design& design, const Schedule& at)
      : trolley{1 / design.crane.trolley_gain_mps2pv},
        slew{(1 + design.crane.trolley_to_jib_ratio() * at.trolley_position_m * at.trolley_position_m) *
             at.inverse_position_pm / design.crane.slew_gain_radps2pv} {}
  double trolley, slew;
};

class LqrTracking final : public Law {
 public:
  LqrTracking(const Design& design, double effort_weight)
      : design_{design}, normalised_{lqr_gains(effort_weight)} {}

  Contribution step(const Measurement& raw, const Reference& raw_reference) noexcept override {
    const Measurement measured = bounded(raw);
    const Reference reference = bounded(raw_reference);
    const Schedule at = schedule(design_, measured);
    const LqrGains k = at_length(normalised_, design_.crane.gravity_mps2, at.cable_length_m);
    const VoltsPerAcceleration per{design_, at};
    const auto acceleration = [&](plant::Axis axis) {
      return k.position * (reference[axis].position - measured.position[axis]) +
             k.speed * (reference[axis].speed - measured.speed[axis]);
    };
    Measurement swing = measured;  // the feed-forward volts contain the force of the planned swing
    swing.swing_radial_rad -= reference.swing.radial_rad;
    swing.swing_tangential_rad -= reference.swing.tangential_rad;
    Contribution result;
    result.drive_v = load_force_volts(design_.crane, swing);
    result.drive_v[kTrolley] += per.trolley * acceleration(kTrolley) + reference.feed_forward_v[kTrolley];
    result.drive_v[kSlew] +=
        per.slew * at.trolley_position_m * acceleration(kSlew) + reference.feed_forward_v[kSlew];
    result.drive_v[kHoist] = hoist_volts(design_, measured, reference);
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override {}

 private:
  Design design_;
  LqrGains normalised_;
};

class LqrAntiSwing final : public Law {
 public:
  LqrAntiSwing(const Design& design, double effort_weight)
      : design_{design}, normalised_{lqr_gains(effort_weight)} {}

  Contribution step(const Measurement& raw, const Reference& raw_reference) noexcept override {
    const Measurement measured = bounded(raw);
    const SwingReference wanted = bounded(raw_reference).swing;
    const Schedule at = schedule(design_, measured);
    const LqrGains k = at_length(normalised_, design_.crane.gravity_mps2, at.cable_length_m);
    const VoltsPerAcceleration per{design_, at};
    Contribution result;
    result.drive_v[kTrolley] =
        per.trolley * (k.swing * (wanted.radial_rad - measured.swing_radial_rad) +
                       k.swing_rate * (wanted.radial_radps - measured.swing_radial_radps));
    result.drive_v[kSlew] =
        -per.slew * (k.swing * (wanted.tangential_rad - measured.swing_tangential_rad) +
                     k.swing_rate * (wanted.tangential_radps - measured.swing_tangential_radps));
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override {}

 private:
  Design design_;
  LqrGains normalised_;
};

}  // namespace

std::unique_ptr<Law> make_lqr_tracking(const Design& design) {
  return std::make_unique<LqrTracking>(design, kEffortWeight);
}
std::unique_ptr<Law> make_lqr_anti_swing(const Design& design) {
  return std::make_unique<LqrAntiSwing>(design, kEffortWeight);
}
std::unique_ptr<Law> make_plan_tracking(const Design& design) {
  return with_observer(std::make_unique<LqrTracking>(design, kPlanEffortWeight), design);
}
std::unique_ptr<Law> make_plan_anti_swing(const Design& design) {
  return with_observer(std::make_unique<LqrAntiSwing>(design, kPlanEffortWeight), design);
}

}  // namespace crane::control
