/// The list of controllers. A new law needs a file of its own and one line here.
/// Equation numbers: H. M. Omar, Control of Gantry and Tower Cranes, Virginia Tech, 2003.
#include <algorithm>

#include "crane/control/anti_swing_pd.hpp"
#include "crane/control/delayed_feedback.hpp"
#include "crane/control/fuzzy.hpp"
#include "crane/control/gain_scheduling.hpp"
#include "crane/control/law.hpp"
#include "crane/control/tracking_pd.hpp"

namespace crane::control {
namespace {

// The optimised gains maximise the damping ratio of the least damped pair of poles below eight load
// frequencies, at K_p = 100. The gains of the source maximise the damping ratio of the right-most pair
// (docs/analysis.md).
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

}  // namespace

const std::vector<Controller>& controllers() {
  using enum ReferenceShape;
  static const std::vector<Controller> kAll{
      {"gain_scheduling_partial", "state feedback without swing rates, (3.19)", step, make_partial_tracking,
       make_partial_anti_swing},
      {"gain_scheduling_full", "full state feedback with a lower forward gain for long moves, (3.26)", step,
       make_full_tracking, make_full_anti_swing},
      {"anti_swing_pd", "tracking PD plus swing PD, (3.45)", bang_coast_bang, make_tracking_pd,
       make_anti_swing_pd},
      {"delayed_1", "tracking PD plus feedback of the delayed swing angle, (3.47)", bang_coast_bang,
       make_tracking_pd, make_delayed_1},
      {"delayed_2", "tracking PD, reference corrected by the delayed swing angle, (3.50)", bang_coast_bang,
       make_tracking_pd, make_delayed_2, true},
      {"fuzzy_printed", "tracking PD plus fuzzy swing rules of Table 3.7", bang_coast_bang, make_tracking_pd,
       make_fuzzy_printed},
      {"fuzzy_generated", "tracking PD plus fuzzy rules generated from delayed_1", bang_coast_bang,
       make_tracking_pd, make_fuzzy_generated},
      {"anti_swing_pd_optimised", "anti_swing_pd with gains of largest minimum damping", bang_coast_bang,
       make_tracking_pd, make_anti_swing_pd_optimised},
      {"delayed_1_optimised", "delayed_1 with gains of largest minimum damping", bang_coast_bang,
       make_tracking_pd, make_delayed_1_optimised},
      {"delayed_2_optimised", "delayed_2 with gains of largest minimum damping", bang_coast_bang,
       make_tracking_pd, make_delayed_2_optimised, true},
      {"none", "tracking PD only, no swing feedback", bang_coast_bang, make_tracking_pd, make_no_anti_swing},
  };
  return kAll;
}

std::vector<std::string> problems(const Controller& controller, const Design& design) {
  if (controller.make_anti_swing != make_fuzzy_generated) return {};
  const auto missing = missing_rules(generated_rules(design));
  if (missing.empty()) return {};
  constexpr std::size_t kNamed = 4;
  std::string places;
  for (std::size_t i = 0; i < std::min(kNamed, missing.size()); ++i)
    places += (i == 0 ? "" : ", ") + missing[i];
  if (missing.size() > kNamed) places += " and " + std::to_string(missing.size() - kNamed) + " more";
  return {std::string(controller.name) + ": no rule for " + places +
          ": the rules are generated from simulations of delayed_1, and no simulation with these gains and "
          "scales reaches these entries of the table; change fuzzy_swing_rad, fuzzy_swing_rate or the gains "
          "of delayed_1"};
}

const Controller* find_controller(std::string_view name) {
  const auto& all = controllers();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace crane::control
