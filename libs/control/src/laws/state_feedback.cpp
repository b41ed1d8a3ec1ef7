#include "crane/control/state_feedback.hpp"

#include "crane/control/hoist.hpp"
#include "crane/control/schedule.hpp"

namespace crane::control {
namespace {

class StateFeedbackTracking final : public Law {
 public:
  StateFeedbackTracking(const Design& design, const StateFeedbackGains& gains)
      : design_{design}, gains_{gains} {}

  Contribution step(const Measurement& raw, const Reference& raw_reference) noexcept override {
    const Measurement measured = bounded(raw);
    const Reference reference = bounded(raw_reference);
    const auto volts = [&](plant::Axis axis, const StateFeedbackAxis& k) {
      return k.position * (reference[axis].position - measured.position[axis]) -
             k.speed * measured.speed[axis];
    };
    Contribution result;
    result.drive_v[kTrolley] = volts(kTrolley, gains_.trolley);
    result.drive_v[kSlew] = volts(kSlew, gains_.slew);
    result.drive_v[kHoist] = hoist_volts(design_, measured, reference);
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override {}

 private:
  Design design_;
  StateFeedbackGains gains_;
};

class StateFeedbackAntiSwing final : public Law {
 public:
  explicit StateFeedbackAntiSwing(const StateFeedbackGains& gains) : gains_{gains} {}

  Contribution step(const Measurement& raw, const Reference& /*reference*/) noexcept override {
    const Measurement measured = bounded(raw);
    Contribution result;
    result.drive_v[kTrolley] = -gains_.trolley.swing * measured.swing_radial_rad -
                               gains_.trolley.swing_rate * measured.swing_radial_radps;
    result.drive_v[kSlew] = -gains_.slew.swing * measured.swing_tangential_rad -
                            gains_.slew.swing_rate * measured.swing_tangential_radps;
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override {}

 private:
  StateFeedbackGains gains_;
};

}  // namespace

std::unique_ptr<Law> make_state_feedback_tracking(const Design& design, const StateFeedbackGains& gains) {
  return std::make_unique<StateFeedbackTracking>(design, gains);
}

std::unique_ptr<Law> make_state_feedback_anti_swing(const Design& /*design*/,
                                                    const StateFeedbackGains& gains) {
  return std::make_unique<StateFeedbackAntiSwing>(gains);
}

}  // namespace crane::control
