#include "crane/control/tracking_pd.hpp"

#include "crane/control/hoist.hpp"
#include "crane/control/schedule.hpp"

namespace crane::control {
namespace {

class TrackingPd final : public Law {
 public:
  explicit TrackingPd(const Design& design) : design_(design) {}

  Contribution step(const Measurement& raw, const Reference& raw_reference) noexcept override {
    const Measurement measured = bounded(raw);
    const Reference reference = bounded(raw_reference);
    const Schedule at = schedule(design_, measured);
    // (3.40) of H. M. Omar, Control of Gantry and Tower Cranes
    const auto pd = [&](plant::Axis axis) {
      return design_.tracking_proportional * (reference[axis].position - measured.position[axis]) +
             at.load_period_s * design_.tracking_derivative * (reference[axis].speed - measured.speed[axis]);
    };
    const double x = at.trolley_position_m;
    const double inertia = 1 + design_.crane.trolley_to_jib_ratio() * x * x;
    Contribution result;
    result.drive_v = load_force_volts(design_.crane, measured);  // second parts of (3.37), (3.38)
    result.drive_v[kTrolley] += trolley_volts(design_.crane, at, pd(kTrolley) / at.cable_length_m);
    result.drive_v[kSlew] +=
        inertia * pd(kSlew) / (design_.crane.slew_gain_radps2pv * at.load_period_s * at.load_period_s);
    result.drive_v[kHoist] = hoist_volts(design_, measured, reference);
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override {}

 private:
  Design design_;
};

class NoAntiSwing final : public Law {
 public:
  Contribution step(const Measurement& /*measured*/, const Reference& /*reference*/) noexcept override {
    return {};
  }
  void reset(const Measurement& /*measured*/) noexcept override {}
};

}  // namespace

std::unique_ptr<Law> make_tracking_pd(const Design& design) { return std::make_unique<TrackingPd>(design); }

std::unique_ptr<Law> make_no_anti_swing(const Design& /*design*/) { return std::make_unique<NoAntiSwing>(); }

}  // namespace crane::control
