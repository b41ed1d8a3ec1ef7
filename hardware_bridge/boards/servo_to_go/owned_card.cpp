#include "crane/boards/registry.hpp"
#include "crane/boards/servo_to_go.hpp"
#include "crane/boards/shared_lines.hpp"

namespace crane::bridge {
namespace {

/// A card with a lock: two bridges on one card would overwrite each other's outputs.
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

}  // namespace

std::unique_ptr<Board> make_servo_to_go_board(const configuration::Rig& rig, const bus::Options& /*bus*/) {
  return std::make_unique<OwnedServoToGo>(rig);
}

}  // namespace crane::bridge
