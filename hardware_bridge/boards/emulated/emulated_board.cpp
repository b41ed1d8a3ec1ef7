#include "crane/boards/emulated_board.hpp"

#include "crane/boards/linked_rig.hpp"
#include "crane/boards/registry.hpp"

namespace crane::bridge {
namespace {

std::unique_ptr<PortIo> ports_of(const configuration::Rig& rig, EmulatedRig& connected) {
  return std::make_unique<EmulatedServoToGo>(static_cast<std::uint16_t>(rig.wiring.base_address),
                                             connected.card(), connected);
}

}  // namespace

EmulatedBoard::EmulatedBoard(const configuration::Rig& rig, std::unique_ptr<EmulatedRig> connected)
    : rig_{std::move(connected)}, driver_{rig, ports_of(rig, *rig_)} {}

Inputs EmulatedBoard::read() {
  rig_->require_alive();
  return driver_.read();
}

bool EmulatedBoard::kick(double radial_radps, double tangential_radps) {
  rig_->kick(radial_radps, tangential_radps);
  return true;
}

/// The crane at the connectors of the emulated card runs in a separate process, crane_emulated_rig.
std::unique_ptr<Board> make_emulated_board(const configuration::Rig& rig, const bus::Options& bus) {
  return std::make_unique<EmulatedBoard>(
      rig, std::make_unique<LinkedRig>(shared_lines_name(bus.crane, bus.domain)));
}

}  // namespace crane::bridge
