#include "crane/control/pendulum_observer.hpp"

#include <algorithm>
#include <cmath>

#include "crane/control/schedule.hpp"
#include "crane/plant/equations.hpp"
#include "crane/plant/pendulum.hpp"

namespace crane::control {
namespace {

constexpr double kDrivePole = 0.6;  // per tick; at 100 Hz a correction of a drive lasts about 20 ms
// Scatter of one reading of a swing encoder: a count of 0.015 deg (section 4.1) rounds by 0.004 deg.
constexpr double kReading_rad = 1e-4;
// Scatter of the modelled swing acceleration per tick. A cable 20 % shorter than measured changes it by
// 0.2 rad/s2 at a swing of 5 deg. A larger value follows a wrong model closer and passes more encoder noise.
constexpr double kModel_radps2 = 0.5;
constexpr double kForce_rad = 0.01;        // standard deviation of the force, as an angle
constexpr double kForceMemory_s = 20;      // correlation time of the force (exponential decay)
constexpr double kStartSwing = 1;          // standard deviation of swing (rad) and rate (rad/s) at the start
constexpr double kStartOffset_rad = 0.02;  // standard deviation of the offset at the start
constexpr double kMostAngle_rad = 1.4;     // the equations are singular at pi/2
constexpr double kMostRate = 1e3;          // m/s, rad/s
constexpr double kStandstill = 1e-3;       // m/s, rad/s: at a lower speed static friction can hold a drive
constexpr int kSubsteps = 2;               // midpoint steps per tick

double limited(double value, double most) noexcept { return std::clamp(value, -most, most); }

bool finite(const Measurement& m) noexcept {
  double sum = m.swing_radial_rad + m.swing_tangential_rad;
  for (std::size_t i = 0; i < kAxes; ++i) sum += m.position[i] + m.speed[i] + m.applied_v[i];
  return std::isfinite(sum);
}

bool finite(const plant::State& state) noexcept {
  double sum = 0;
  for (const double value : plant::to_array(state)) sum += value;
  return std::isfinite(sum);
}

/// Friction of a moving drive, (3.1) of H. M. Omar, Control of Gantry and Tower Cranes.
double friction_v(const DriveFriction& f, double speed) noexcept {
  const double moving = speed > 0 ? f.coulomb_positive_v + f.viscous_positive_vspm * speed
                                  : -f.coulomb_negative_v + f.viscous_negative_vspm * speed;
  return f.factor * moving;
}

/// True when static friction holds the drive.
bool sticks(const DriveFriction& f, double speed, double drive_v) noexcept {
  return std::abs(speed) < kStandstill && drive_v <= f.factor * f.coulomb_positive_v &&
         drive_v >= -f.factor * f.coulomb_negative_v;
}

/// Volts and forces that act on the crane during a tick.
struct Drives {
  double trolley_v, slew_v;           ///< including the unexplained volts
  double radial_rad, tangential_rad;  ///< forces on the load
};

plant::StateArray derivative(const Design& design, const plant::State& s, const Drives& drives) noexcept {
  const plant::Parameters& crane = design.crane;
  plant::Locks locks;
  locks.axis[kTrolley] = sticks(design.friction[kTrolley], s.trolley_mps, drives.trolley_v);
  locks.axis[kSlew] = sticks(design.friction[kSlew], s.slew_radps, drives.slew_v);
  const double weight = crane.load_mass_kg * crane.gravity_mps2 * s.cable_m;
  const double trolley_v = drives.trolley_v - friction_v(design.friction[kTrolley], s.trolley_mps);
  const double slew_v = drives.slew_v - friction_v(design.friction[kSlew], s.slew_radps);
  const auto a =
      plant::accelerations(crane, s,
                           {.trolley_n = crane.trolley_inertia_kg * crane.trolley_gain_mps2pv * trolley_v,
                            .radial_nm = weight * drives.radial_rad,
                            .slew_nm = crane.jib_inertia_kgm2 * crane.slew_gain_radps2pv * slew_v,
                            .tangential_nm = weight * drives.tangential_rad},
                           0, locks);
  return {s.trolley_mps,  s.radial_radps,  s.slew_radps,  s.tangential_radps,  s.cable_mps,
          a.trolley_mps2, a.radial_radps2, a.slew_radps2, a.tangential_radps2, 0};
}

plant::State moved(const plant::State& state, const plant::StateArray& rate, double time_s) noexcept {
  auto values = plant::to_array(state);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] += time_s * rate[i];
  return plant::to_state(values);
}

plant::State within_model(plant::State state) noexcept {
  constexpr double kFar = 1e6;
  for (double* angle : {&state.radial_rad, &state.tangential_rad}) *angle = limited(*angle, kMostAngle_rad);
  for (double* rate : {&state.trolley_mps, &state.radial_radps, &state.slew_radps, &state.tangential_radps,
                       &state.cable_mps})
    *rate = limited(*rate, kMostRate);
  state.trolley_m = limited(state.trolley_m, kFar);
  state.slew_rad = limited(state.slew_rad, kFar);
  return state;
}

}  // namespace

PendulumObserver::PendulumObserver(const Design& design) : design_(design) {}

void PendulumObserver::reset(const Measurement& raw) noexcept {
  const Measurement measured = bounded(raw);
  started_ = finite(measured);
  if (!started_) return;
  estimate_ = {};
  plant::State& s = estimate_.state;
  s.trolley_m = measured.position[kTrolley];
  s.slew_rad = measured.position[kSlew];
  s.cable_m = schedule(design_, measured).cable_length_m;
  s.radial_rad = limited(measured.swing_radial_rad, kMostAngle_rad);
  s.tangential_rad = limited(measured.swing_tangential_rad, kMostAngle_rad);
  const double swing = kStartSwing * kStartSwing;
  Plane start;
  start.covariance.diagonal() << swing, swing, kForce_rad * kForce_rad, kStartOffset_rad * kStartOffset_rad;
  radial_ = tangential_ = start;
}

const CraneEstimate& PendulumObserver::step(const Measurement& raw) noexcept {
  const Measurement measured = bounded(raw);
  if (!finite(measured)) return estimate_;
  if (!started_)
    reset(measured);
  else
    correct(measured);
  predict(measured);
  const double covariance_sum = radial_.covariance.sum() + tangential_.covariance.sum();
  if (!finite(estimate_.state) || !std::isfinite(covariance_sum))
    reset(measured);  // diverged because of unrealistic parameters
  return estimate_;
}

void PendulumObserver::correct(const Measurement& measured) noexcept {
  constexpr double p = kDrivePole;  // three poles at p for position, speed and unexplained acceleration
  constexpr double kPosition = 1 - p * p * p, kSpeed = 1.5 * (1 - p) * (1 - p) * (1 + p),
                   kAcceleration = (1 - p) * (1 - p) * (1 - p);
  const double period_s = design_.period_s;
  plant::State& s = estimate_.state;
  const auto drive = [&](plant::Axis axis, double& position, double& speed, double gain) {
    const double error = measured.position[axis] - position;
    position += kPosition * error;
    speed += kSpeed / period_s * error;
    double& unexplained = estimate_.unexplained_v[axis];
    unexplained = limited(unexplained + kAcceleration / (period_s * period_s * gain) * error,
                          2 * design_.volt_limit_v[axis]);
  };
  const double x = s.trolley_m;
  drive(kTrolley, s.trolley_m, s.trolley_mps, design_.crane.trolley_gain_mps2pv);
  drive(kSlew, s.slew_rad, s.slew_radps,
        design_.crane.slew_gain_radps2pv / (1 + design_.crane.trolley_to_jib_ratio() * x * x));
  correct(radial_, s.radial_rad, s.radial_radps, measured.swing_radial_rad);
  correct(tangential_, s.tangential_rad, s.tangential_radps, measured.swing_tangential_rad);
  s = within_model(s);
}

void PendulumObserver::correct(Plane& plane, double& angle, double& rate, double measured) const noexcept {
  const Eigen::Vector4d seen = plane.covariance.col(0) + plane.covariance.col(3);  // P H', H = (1, 0, 0, 1)
  const double variance = seen[0] + seen[3] + kReading_rad * kReading_rad;
  const double error = measured - (angle + plane.unknowns.offset_rad);
  const Eigen::Vector4d gain = seen / variance;
  angle += gain[0] * error;
  rate += gain[1] * error;
  plane.unknowns.force_rad = limited(plane.unknowns.force_rad + gain[2] * error, kMostAngle_rad);
  plane.unknowns.offset_rad = limited(plane.unknowns.offset_rad + gain[3] * error, kMostAngle_rad);
  plane.covariance -= gain * seen.transpose();
  plane.covariance = (0.5 * (plane.covariance + plane.covariance.transpose())).eval();
}

void PendulumObserver::predict(const Measurement& measured) noexcept {
  plant::State& s = estimate_.state;
  s.cable_m = schedule(design_, measured).cable_length_m;
  s.cable_mps = limited(measured.speed[kHoist], kMostRate);
  const Drives drives{.trolley_v = measured.applied_v[kTrolley] + estimate_.unexplained_v[kTrolley],
                      .slew_v = measured.applied_v[kSlew] + estimate_.unexplained_v[kSlew],
                      .radial_rad = radial_.unknowns.force_rad,
                      .tangential_rad = tangential_.unknowns.force_rad};
  const double step_s = design_.period_s / kSubsteps;
  for (int i = 0; i < kSubsteps; ++i) {
    const plant::State middle = moved(s, derivative(design_, s, drives), step_s / 2);
    s = within_model(moved(s, derivative(design_, middle, drives), step_s));
  }
  s.cable_m = std::clamp(s.cable_m, design_.shortest_cable_length_m, design_.longest_cable_length_m);
  predict(radial_);
  predict(tangential_);
  estimate_.radial = radial_.unknowns;
  estimate_.tangential = tangential_.unknowns;
}

void PendulumObserver::predict(Plane& plane) const noexcept {
  const double t = design_.period_s;
  const double square = design_.crane.gravity_mps2 / estimate_.state.cable_m;  // w0^2
  const double kept = std::exp(-t / kForceMemory_s);
  Matrix4 step;
  step << 1 - square * t * t / 2, t, square * t * t / 2, 0,  //
      -square * t, 1, square * t, 0,                         //
      0, 0, kept, 0,                                         //
      0, 0, 0, 1;
  const Eigen::Vector4d model{kModel_radps2 * t * t / 2, kModel_radps2 * t, 0, 0};
  plane.covariance = (step * plane.covariance * step.transpose() + model * model.transpose()).eval();
  plane.covariance(2, 2) += kForce_rad * kForce_rad * (1 - kept * kept);
  plane.unknowns.force_rad *= kept;
}

Measurement predicted_measurement(const CraneEstimate& estimate) noexcept {
  const plant::State& s = estimate.state;
  return {.position = {s.trolley_m, s.slew_rad, s.cable_m},
          .speed = {s.trolley_mps, s.slew_radps, s.cable_mps},
          .swing_radial_rad = s.radial_rad - estimate.radial.force_rad,
          .swing_radial_radps = s.radial_radps,
          .swing_tangential_rad = s.tangential_rad - estimate.tangential.force_rad,
          .swing_tangential_radps = s.tangential_radps};
}

namespace {

/// A law whose input is the predicted state of the crane at the time when the command acts.
class ObservedLaw final : public Law {
 public:
  ObservedLaw(std::unique_ptr<Law> law, const Design& design)
      : law_{std::move(law)}, observer_{design}, period_s_{design.period_s} {}

  Contribution step(const Measurement& measured, const Reference& reference) noexcept override {
    // NaN is passed on to the law and, through the output of the law, to the gate of the supervisor.
    const Measurement ahead = finite(measured) ? predicted_measurement(observer_.step(measured)) : measured;
    Reference wanted = reference;
    for (auto& axis : wanted) {
      axis.position += period_s_ * (axis.speed + period_s_ / 2 * axis.acceleration);
      axis.speed += period_s_ * axis.acceleration;
    }
    return law_->step(ahead, wanted);
  }
  void reset(const Measurement& measured) noexcept override {
    observer_.reset(measured);
    law_->reset(measured);
  }

 private:
  std::unique_ptr<Law> law_;
  PendulumObserver observer_;
  double period_s_;
};

}  // namespace

std::unique_ptr<Law> with_observer(std::unique_ptr<Law> law, const Design& design) {
  if (dynamic_cast<const ObservedLaw*>(law.get()) != nullptr) return law;
  return std::make_unique<ObservedLaw>(std::move(law), design);
}

std::unique_ptr<Law> tracking_law(const Controller& controller, const Design& design) {
  auto law = controller.make_tracking(design);
  return design.swing_observer ? with_observer(std::move(law), design) : std::move(law);
}

std::unique_ptr<Law> anti_swing_law(const Controller& controller, const Design& design) {
  auto law = controller.make_anti_swing(design);
  return design.swing_observer ? with_observer(std::move(law), design) : std::move(law);
}

}  // namespace crane::control
