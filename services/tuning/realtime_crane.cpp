#include "tuning/realtime_crane.hpp"

#include <utility>

#include "experiments/rig_at_start_file.hpp"
#include "tuning/tune.hpp"

namespace crane::tuning {

RealtimeCrane::RealtimeCrane(RealtimeOptions options)
    : directory_{std::move(options.directory)},
      lock_{directory_, files::IfLocked::fail},
      runs_{{.plant = options.plant, .bus = std::move(options.bus), .vendors = std::move(options.vendors)}} {}

Motion RealtimeCrane::execute(const configuration::Rig& rig, const experiment::Scenario& scenario) {
  const auto file = directory_ / kMotionRigFile;
  experiments::write_rig_at_start(file, rig);
  auto run = runs_.run(file, "none", scenario);
  return {std::move(run.table), "", std::move(run.differences)};
}

}  // namespace crane::tuning
