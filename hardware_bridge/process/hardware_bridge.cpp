#include "crane/boards/board_uses.hpp"
#include "crane/boards/registry.hpp"
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
            auto board = board_kind_of(context.rig).make(context.rig, context.bus);
            count_board_use(context.rig, context.bus.crane, context.bus.domain);
            return std::make_unique<Bridge>(context, std::move(board));
          }};
}

}  // namespace crane::bridge
