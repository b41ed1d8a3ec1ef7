/// Adds a control law without a change to the project: state feedback with eight gains. The example runs the
/// law in lockstep on the simulated tower crane and compares it with the controller of the rig file.
#include <cstdio>
#include <numbers>

#include "crane/control/state_feedback.hpp"
#include "crane/control/tracking_pd.hpp"
#include "experiments/experiment_run.hpp"
#include "stack/data_files.hpp"

namespace {

using namespace crane;

/// Gains of position, speed, swing and swing rate, in V per m, m/s, rad and rad/s (slew: per rad, rad/s):
/// (3.22) to (3.26) of H. M. Omar, Control of Gantry and Tower Cranes, with K = 4, for a cable of 1 m and a
/// trolley at 1 m.
constexpr control::StateFeedbackGains kGains{.trolley = {4, 5.28, 15.0, -0.15},
                                             .slew = {4, 5.92, -15.7, -3.24}};

std::unique_ptr<control::Law> make_own_tracking(const control::Design& design) {
  return control::make_state_feedback_tracking(design, kGains);
}
std::unique_ptr<control::Law> make_own_anti_swing(const control::Design& design) {
  return control::make_state_feedback_anti_swing(design, kGains);
}

const control::Controller kOwnLaw{"own_law", "state feedback with constant gains",
                                  control::ReferenceShape::step, make_own_tracking, make_own_anti_swing};

void report(const control::Controller& controller) {
  const auto rig = configuration::load_rig(stack::find_rig("virginia_tech_tower"));
  const auto scenario = experiment::load_scenario(stack::find_scenario("maneuver_1"), &rig);
  const auto started = experiment::with_start_of(rig, scenario);
  experiments::TickLog log{std::nullopt};  // no recording, only the table
  const auto outcome = experiments::run_in_process(started, controller, scenario, log);
  const auto metrics = experiment::evaluate(experiment::samples_from(log.table(outcome.hold_tick)),
                                            experiment::maneuver_of(scenario, started));
  constexpr double kDegPerRad = 180 / std::numbers::pi;
  const double settled_s = metrics.settling_time_s.value_or(-1);
  std::printf("%-24s settled after %.2f s, largest swing %.1f deg\n", std::string{controller.name}.c_str(),
              settled_s, metrics.largest_swing_radial_rad * kDegPerRad);
}

}  // namespace

int main() {
  report(*control::find_controller("gain_scheduling_partial"));
  report(kOwnLaw);
  return 0;
}
