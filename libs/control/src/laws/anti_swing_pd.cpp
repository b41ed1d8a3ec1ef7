#include "crane/control/anti_swing_pd.hpp"

#include "crane/control/schedule.hpp"

namespace crane::control {
namespace {

class AntiSwingPd final : public Law {
 public:
  explicit AntiSwingPd(const Design& design) : design_(design) {}

  Contribution step(const Measurement& raw, const Reference& /*reference*/) noexcept override {
    const Measurement measured = bounded(raw);
    const Schedule at = schedule(design_, measured);
    // (3.45) of H. M. Omar, Control of Gantry and Tower Cranes
    const auto pd = [&](double swing_rad, double swing_radps) {
      return design_.anti_swing_proportional * swing_rad +
             at.load_period_s * design_.anti_swing_derivative * swing_radps;
    };
    Contribution result;
    result.drive_v[kTrolley] =
        trolley_volts(design_.crane, at, pd(measured.swing_radial_rad, measured.swing_radial_radps));
    result.drive_v[kSlew] =
        slew_volts(design_.crane, at, pd(measured.swing_tangential_rad, measured.swing_tangential_radps));
    return result;
  }
  void reset(const Measurement& /*measured*/) noexcept override {}

 private:
  Design design_;
};

}  // namespace

std::unique_ptr<Law> make_anti_swing_pd(const Design& design) {
  return std::make_unique<AntiSwingPd>(design);
}

}  // namespace crane::control
