#include "crane/control/gain_scheduling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "crane/control/hoist.hpp"

namespace crane::control {
namespace {

using std::numbers::pi;
using std::numbers::sqrt2;

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes (gain_scheduling.hpp).

/// Ratio w/w0 for which K_phi' = 0: positive root of (4/pi) r^2 - sqrt(2) (1 - 4/pi^2) r - 4/pi = 0.
double partial_frequency_ratio() noexcept {
  const double linear = sqrt2 * (1 - 4 / (pi * pi));
  return (linear + std::sqrt(linear * linear + 64 / (pi * pi))) * pi / 8;
}

/// Gains of one tick for partial-state feedback, which has no memory.
class PartialGains {
 public:
  explicit PartialGains(const Design& design) : design_(design) {}
  [[nodiscard]] TowerGains step(const Measurement& measured, const Reference& /*reference*/) noexcept {
    return partial_state_gains(design_, schedule(design_, measured));
  }
  void reset() noexcept {}

 private:
  Design design_;
};

class FullGains {
 public:
  explicit FullGains(const Design& design) : design_(design) {}
  [[nodiscard]] TowerGains step(const Measurement& measured, const Reference& reference) noexcept {
    return full_state_gains(design_, schedule(design_, measured), forward_gains(design_, reference));
  }
  void reset() noexcept {}

 private:
  Design design_;
};

template <typename TickGains>
class Tracking final : public Law {
 public:
  explicit Tracking(const Design& design) : design_(design), gains_(design) {}

  Contribution step(const Measurement& raw, const Reference& raw_reference) noexcept override {
    const Measurement measured = bounded(raw);
    const Reference reference = bounded(raw_reference);
    const TowerGains gains = gains_.step(measured, reference);
    const auto volts = [&](plant::Axis axis, const Gains& k) {  // (3.26), terms of position and speed
      return k.position *
             (reference[axis].position - measured.position[axis] - k.speed * measured.speed[axis]);
    };
    Contribution result;
    result.drive_v[kTrolley] = volts(kTrolley, gains.trolley);
    result.drive_v[kSlew] = volts(kSlew, gains.slew);
    result.drive_v[kHoist] = hoist_volts(design_, measured, reference);
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override { gains_.reset(); }

 private:
  Design design_;
  TickGains gains_;
};

template <typename TickGains>
class AntiSwing final : public Law {
 public:
  explicit AntiSwing(const Design& design) : gains_(design) {}

  Contribution step(const Measurement& raw, const Reference& raw_reference) noexcept override {
    const Measurement measured = bounded(raw);
    const auto [trolley, slew] = gains_.step(measured, bounded(raw_reference));
    Contribution result;  // (3.26), terms of the swing
    result.drive_v[kTrolley] = -trolley.position * (trolley.swing * measured.swing_radial_rad +
                                                    trolley.swing_rate * measured.swing_radial_radps);
    result.drive_v[kSlew] = slew.position * (slew.swing * measured.swing_tangential_rad +
                                             slew.swing_rate * measured.swing_tangential_radps);
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override { gains_.reset(); }

 private:
  TickGains gains_;
};

/// Swing gains of the slew axis: K_theta = K_phi / x, K_theta' = K_phi' / x.
Gains with_swing_gains_per_position(Gains gains, const Schedule& at) noexcept {
  gains.swing *= at.inverse_position_pm;
  gains.swing_rate *= at.inverse_position_pm;
  return gains;
}

}  // namespace

SwingAxis trolley_axis(const plant::Parameters& crane, double cable_length_m) noexcept {
  return {crane.gravity_mps2, cable_length_m, crane.trolley_gain_mps2pv, crane.load_to_trolley_ratio()};
}

SwingAxis slew_axis(const plant::Parameters& crane, double cable_length_m,
                    double trolley_position_m) noexcept {
  const double square = trolley_position_m * trolley_position_m;
  const double inertia = 1 + crane.trolley_to_jib_ratio() * square;
  return {crane.gravity_mps2, cable_length_m, crane.slew_gain_radps2pv / inertia,
          crane.load_to_jib_ratio() * square / inertia};
}

Gains partial_state_gains(const SwingAxis& axis) noexcept {
  static const double kRatio = partial_frequency_ratio();
  const double w0_squared = axis.gravity_mps2 / axis.cable_length_m;
  const double forward_gain = 4 / (pi * pi) * kRatio * kRatio * w0_squared / axis.drive_gain;
  Gains gains = full_state_gains(axis, forward_gain);
  gains.swing_rate = 0;  // removes the rounding error of K_phi' = 0
  return gains;
}

Gains full_state_gains(const SwingAxis& axis, double forward_gain) noexcept {
  const double loop = forward_gain * axis.drive_gain;
  const double w0_squared = axis.gravity_mps2 / axis.cable_length_m;
  const double a = 2 / pi * std::sqrt(w0_squared);  // (3.21)
  const double w = pi / 2 * std::sqrt(loop);        // (3.25)
  Gains gains;
  gains.position = forward_gain;
  gains.speed = 2 / a + sqrt2 / w;     // (3.24)
  gains.swing = axis.cable_length_m *  // (3.23)
                ((a * a + 2 * sqrt2 * a * w + w * w - w0_squared * (1 + axis.load_ratio)) / loop - 1);
  gains.swing_rate = axis.cable_length_m * ((2 * a + sqrt2 * w) / loop - gains.speed);  // (3.22)
  return gains;
}

TowerGains partial_state_gains(const Design& design, const Schedule& at) noexcept {
  return {partial_state_gains(trolley_axis(design.crane, at.cable_length_m)),
          with_swing_gains_per_position(
              partial_state_gains(slew_axis(design.crane, at.cable_length_m, at.trolley_position_m)), at)};
}

TowerGains full_state_gains(const Design& design, const Schedule& at,
                            const ForwardGains& forward_gains) noexcept {
  return {full_state_gains(trolley_axis(design.crane, at.cable_length_m), forward_gains.trolley),
          with_swing_gains_per_position(
              full_state_gains(slew_axis(design.crane, at.cable_length_m, at.trolley_position_m),
                               forward_gains.slew),
              at)};
}

double forward_gain_within(double volt_limit_v, double distance, double gain_limit) noexcept {
  const double first_command_v = std::abs(distance) * gain_limit;
  return first_command_v > volt_limit_v ? volt_limit_v / std::abs(distance) : gain_limit;
}

double available_control_v(const Design& design, plant::Axis axis, bool positive) noexcept {
  const DriveFriction& friction = design.friction[axis];
  const double friction_v = positive ? std::max(friction.stiction_positive_v, friction.coulomb_positive_v)
                                     : std::max(friction.stiction_negative_v, friction.coulomb_negative_v);
  return design.volt_limit_v[axis] - friction.factor * friction_v;
}

ForwardGains forward_gains(const Design& design, const Reference& reference) noexcept {
  const auto gain = [&](plant::Axis axis) {
    const double distance = reference[axis].position - reference[axis].start;
    return forward_gain_within(available_control_v(design, axis, distance > 0), distance,
                               design.full_state_forward_gain_vpm);
  };
  return {gain(kTrolley), gain(kSlew)};
}

std::unique_ptr<Law> make_partial_tracking(const Design& design) {
  return std::make_unique<Tracking<PartialGains>>(design);
}
std::unique_ptr<Law> make_partial_anti_swing(const Design& design) {
  return std::make_unique<AntiSwing<PartialGains>>(design);
}
std::unique_ptr<Law> make_full_tracking(const Design& design) {
  return std::make_unique<Tracking<FullGains>>(design);
}
std::unique_ptr<Law> make_full_anti_swing(const Design& design) {
  return std::make_unique<AntiSwing<FullGains>>(design);
}

}  // namespace crane::control
