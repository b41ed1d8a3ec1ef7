#include "tuning/realtime_crane.hpp"

#include "experiments/realtime_run.hpp"
#include "experiments/started_rig_file.hpp"

namespace crane::tuning {

Motion RealtimeCrane::execute(const configuration::Rig& rig, const experiment::Scenario& scenario) {
  const auto file = options_.directory / "motion_rig.toml";
  experiments::write_started_rig(file, rig);
  return {experiments::run_in_realtime({.rig = file,
                                        .controller = "none",
                                        .plant = options_.plant,
                                        .bus = options_.bus,
                                        .vendors = options_.vendors},
                                       scenario),
          ""};
}

}  // namespace crane::tuning
