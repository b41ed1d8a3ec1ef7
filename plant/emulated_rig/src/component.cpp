#include "crane/emulated_rig/component.hpp"

#include "crane/bridge/bridge.hpp"
#include "crane/bridge/component.hpp"
#include "crane/emulated_rig/wired_rig.hpp"

namespace crane::emulated_rig {

std::unique_ptr<bridge::Board> open_board(const configuration::Rig& rig) {
  return std::make_unique<bridge::EmulatedBoard>(rig, std::make_unique<WiredRig>(rig));
}

runtime::ComponentSpec hardware_bridge_spec() {
  auto spec = bridge::hardware_bridge_spec();
  spec.make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
    const auto& kind = bridge::board_kind_of(context.rig);
    const bool in_process = context.bus.vendor == bus::Vendor::memory && kind.name == "emulated";
    return std::make_unique<bridge::Bridge>(
        context, in_process ? open_board(context.rig) : kind.make(context.rig, context.bus));
  };
  return spec;
}

}  // namespace crane::emulated_rig
