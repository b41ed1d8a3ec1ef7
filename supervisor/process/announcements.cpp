#include "process/announcements.hpp"

#include <string>

#include "crane/plant/coordinates.hpp"

namespace crane::supervisor {

void announce(runtime::Node& node, const Limits& limits, const TickOutput& output, std::size_t homing_axis) {
  const std::string what =
      std::string{name_of(output.state)} +
      (output.cause == Cause::none ? "" : std::string{" because of "} + name_of(output.cause));
  const bool intended = output.cause == Cause::operator_stop || output.cause == Cause::operator_disarm ||
                        output.cause == Cause::idle || output.cause == Cause::homed;
  if (output.cause == Cause::homing_failed && output.state == State::stop_c0)  // not again in LOCKED
    node.error("homing_failed",
               std::string{"homing of the "} + plant::kCoordinates[homing_axis].name +
                   " axis failed: " + name_of(output.homing_failure),
               remedy_for(output.homing_failure));
  if (output.cause == Cause::zone && output.state == State::stop_c1)
    node.error("zone", "the load could have swung into zone " + limits.zones.at(output.zone).name,
               remedy_for(output.cause));
  const bool trouble = output.state >= State::stop_c1 && !intended;
  if (trouble)
    node.error("supervisor_state", what, remedy_for(output.cause));
  else
    node.info("supervisor_state", what);
}

void announce_unchecked(runtime::Node& node) {
  node.warning(
      "model_checks_off",
      "the crane is armed with model_checks = false: with a wrong or exchanged encoder, an axis may stop "
      "only at its limit switch",
      "test drives and encoders with `crane hw selftest` first; set model_checks = true when the model "
      "of the rig file is known");
}

void announce_wrong_time(runtime::Node& node, const msg::Header& header) {
  node.error("sample_time",
             "the sample time of tick " + std::to_string(header.tick) +
                 " of crane/state contradicts its tick: " + std::to_string(header.sample_time_ns) + " ns",
             "restart the bridge; if the event repeats, another program forges packets: use keys (crane up "
             "--secure)");
}

}  // namespace crane::supervisor
