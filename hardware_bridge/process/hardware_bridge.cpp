#include "crane/bridge/bridge.hpp"
#include "crane/bridge/component.hpp"

namespace crane::bridge {

runtime::ComponentSpec hardware_bridge_spec() {
  return {.name = "hardware_bridge",
          .program = "crane_hardware_bridge",
          .summary =
              "Hardware bridge: reads the board of the rig file, checks every command, and drives "
              "converters, brakes "
              "and watchdog.",
          .source = crane_SOURCE_BRIDGE,
          .runs_controller = false,
          .reads = bridge_reads(),
          .writes = bridge_writes(),
          .make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
            return std::make_unique<Bridge>(context,
                                            board_kind_of(context.rig).make(context.rig, context.bus));
          }};
}

}  // namespace crane::bridge
