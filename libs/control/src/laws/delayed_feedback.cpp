#include "crane/control/delayed_feedback.hpp"

#include <cmath>

#include "crane/control/delay_line.hpp"
#include "crane/control/schedule.hpp"
#include "crane/plant/pendulum.hpp"

namespace crane::control {
namespace {

// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes (delayed_feedback.hpp).

/// Length of `delay` load periods in ticks, with the longest cable.
double longest_delay_ticks(const Design& design, double delay) {
  const double longest_period_s =
      plant::swing_period_s(design.crane.gravity_mps2, design.longest_cable_length_m);
  return delay * longest_period_s / design.period_s;
}

class Delayed1 final : public Law {
 public:
  explicit Delayed1(const Design& design)
      : design_(design),
        radial_(longest_delay_ticks(design, design.delayed_1_delay)),
        tangential_(longest_delay_ticks(design, design.delayed_1_delay)) {}

  Contribution step(const Measurement& raw, const Reference& /*reference*/) noexcept override {
    const Measurement measured = bounded(raw);
    const Schedule at = schedule(design_, measured);
    const double delay_ticks = design_.delayed_1_delay * at.load_period_s / design_.period_s;
    radial_.push(measured.swing_radial_rad);
    tangential_.push(measured.swing_tangential_rad);
    Contribution result;  // (3.47)
    result.drive_v[kTrolley] =
        trolley_volts(design_.crane, at, design_.delayed_1_gain * radial_.at(delay_ticks));
    result.drive_v[kSlew] =
        slew_volts(design_.crane, at, design_.delayed_1_gain * tangential_.at(delay_ticks));
    return result;
  }

  void reset(const Measurement& raw) noexcept override {
    const Measurement measured = bounded(raw);
    radial_.reset(measured.swing_radial_rad);
    tangential_.reset(measured.swing_tangential_rad);
  }

 private:
  Design design_;
  DelayLine radial_, tangential_;
};

class Delayed2 final : public Law {
 public:
  explicit Delayed2(const Design& design)
      : design_(design),
        radial_(longest_delay_ticks(design, design.delayed_2_delay)),
        radial_rate_(radial_),
        tangential_(radial_),
        tangential_rate_(radial_) {}

  Contribution step(const Measurement& raw, const Reference& /*reference*/) noexcept override {
    const Measurement measured = bounded(raw);
    const Schedule at = schedule(design_, measured);
    const double delay_ticks = design_.delayed_2_delay * at.load_period_s / design_.period_s;
    radial_.push(measured.swing_radial_rad);
    radial_rate_.push(measured.swing_radial_radps);
    tangential_.push(measured.swing_tangential_rad);
    tangential_rate_.push(measured.swing_tangential_radps);
    const double trolley_gain = at.cable_length_m * design_.delayed_2_gain;  // L K_del, m/rad
    const double slew_gain = -trolley_gain * at.inverse_position_pm;         // -(L/x) K_del, rad/rad
    Contribution result;                                                     // figure 3.18
    result.correction[kTrolley] = {trolley_gain * radial_.at(delay_ticks),
                                   trolley_gain * radial_rate_.at(delay_ticks), 0};
    result.correction[kSlew] = {slew_gain * tangential_.at(delay_ticks),
                                slew_gain * tangential_rate_.at(delay_ticks), 0};
    return result;
  }

  void reset(const Measurement& raw) noexcept override {
    const Measurement measured = bounded(raw);
    radial_.reset(measured.swing_radial_rad);
    tangential_.reset(measured.swing_tangential_rad);
    radial_rate_.reset(0);
    tangential_rate_.reset(0);
  }

 private:
  Design design_;
  DelayLine radial_, radial_rate_, tangential_, tangential_rate_;
};

}  // namespace

std::unique_ptr<Law> make_delayed_1(const Design& design) { return std::make_unique<Delayed1>(design); }

std::unique_ptr<Law> make_delayed_2(const Design& design) { return std::make_unique<Delayed2>(design); }

}  // namespace crane::control
