/// Gains that maximise the damping ratio of the least damped pair of poles below eight load frequencies, at
/// K_p = 100. The gains of the source maximise the damping ratio of the right-most pair (docs/analysis.md).
#include "crane/control/anti_swing_pd.hpp"
#include "crane/control/delayed_feedback.hpp"

namespace crane::control {

std::unique_ptr<Law> make_anti_swing_pd_optimised(const Design& design) {
  Design optimised = design;
  optimised.anti_swing_proportional = -25.66;
  optimised.anti_swing_derivative = 7.434;
  return make_anti_swing_pd(optimised);
}

std::unique_ptr<Law> make_delayed_1_optimised(const Design& design) {
  Design optimised = design;
  optimised.delayed_1_gain = -49.38;
  optimised.delayed_1_delay = 0.1193;
  return make_delayed_1(optimised);
}

std::unique_ptr<Law> make_delayed_2_optimised(const Design& design) {
  Design optimised = design;
  optimised.delayed_2_gain = -0.423;
  optimised.delayed_2_delay = 0.179;
  return make_delayed_2(optimised);
}

}  // namespace crane::control
