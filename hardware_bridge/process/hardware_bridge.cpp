#include "crane/bridge/component.hpp"

#include <algorithm>

#include "crane/boards/comedi.hpp"
#include "crane/boards/emulated_board.hpp"
#include "crane/boards/linked_rig.hpp"
#include "crane/bridge/bridge.hpp"

namespace crane::bridge {
namespace {

/// A card with a lock: two bridges on one card would write past each other.
class OwnedServoToGo final : public Board {
 public:
  explicit OwnedServoToGo(const configuration::Rig& rig)
      : lock_{"/crane_servo_to_go_" + std::to_string(rig.wiring.base_address)}, card_{rig, ports(rig)} {}

  [[nodiscard]] std::string_view name() const override { return card_.name(); }
  [[nodiscard]] Inputs read() override { return card_.read(); }
  std::array<double, kDrives> write(const Outputs& outputs) override { return card_.write(outputs); }
  void make_safe() noexcept override { card_.make_safe(); }
  void advance_to(std::int64_t /*time_ns*/) override {}

 private:
  std::unique_ptr<PortIo> ports(const configuration::Rig& rig) {
    if (!lock_.take(SharedFile::Role::bridge))
      throw BoardError(
          "another hardware bridge uses this board: stop it first, or correct base_address in [wiring]");
    return open_ports(static_cast<std::uint16_t>(rig.wiring.base_address));
  }
  SharedFile lock_;
  ServoToGo card_;
};

std::unique_ptr<Board> make_servo_to_go(const configuration::Rig& rig, const bus::Options& /*bus*/) {
  return std::make_unique<OwnedServoToGo>(rig);
}

std::unique_ptr<Board> make_comedi(const configuration::Rig& rig, const bus::Options& /*bus*/) {
  return std::make_unique<Comedi>(rig);
}

/// The crane at the plugs of the emulated card is a process of its own, crane_emulated_rig.
std::unique_ptr<Board> make_emulated(const configuration::Rig& rig, const bus::Options& bus) {
  return std::make_unique<EmulatedBoard>(
      rig, std::make_unique<LinkedRig>(shared_lines_name(bus.crane, bus.domain)));
}

}  // namespace

const std::vector<BoardKind>& board_kinds() {
  static const std::vector<BoardKind> kinds{
      {"servo_to_go", make_servo_to_go}, {"comedi", make_comedi}, {"emulated", make_emulated}};
  return kinds;
}

const BoardKind& board_kind_of(const configuration::Rig& rig) {
  const auto& kinds = board_kinds();
  const auto found = std::find_if(kinds.begin(), kinds.end(),
                                  [&rig](const BoardKind& kind) { return kind.name == rig.board; });
  if (found != kinds.end()) return *found;
  std::string names;
  for (const auto& kind : kinds) names += (names.empty() ? "" : ", ") + std::string{kind.name};
  throw configuration::ConfigurationError(
      {rig.path + ": board = " + rig.board + ": the hardware bridge drives " + names +
       "; choose one of them, or run the simulated plant (crane up --plant sim)"});
}

runtime::ComponentSpec hardware_bridge_spec() {
  return {
      .name = "hardware_bridge",
      .program = "crane_hardware_bridge",
      .summary =
          "The bridge's loop on the board that the rig file names: encoders, converters, brakes, watchdog.",
      .source = crane_SOURCE_BRIDGE,
      .runs_controller = false,
      .reads = bridge_reads(),
      .writes = bridge_writes(),
      .make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
        return std::make_unique<Bridge>(context, board_kind_of(context.rig).make(context.rig, context.bus));
      }};
}

}  // namespace crane::bridge
