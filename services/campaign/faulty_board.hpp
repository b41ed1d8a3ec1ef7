#pragma once
/// The simulated rig, and the wires between it and the bridge, which a fault may spoil.
#include <functional>
#include <memory>

#include "campaign/judge/record.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace crane::campaign {

/// What outlives the bridge: the rig goes on when the process in front of it has ended.
class World {
 public:
  /// @param wired  the rig as it is; `told` is what its file says
  World(const configuration::Rig& told, const configuration::Rig& wired);

  std::function<void(bridge::Inputs&)> spoil_inputs;    ///< between rig and bridge; empty: nothing
  std::function<void(bridge::Outputs&)> spoil_outputs;  ///< between bridge and rig

  [[nodiscard]] bridge::Inputs read();
  std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs);
  void make_safe() noexcept;
  [[nodiscard]] simulator::SimulatedBoard& board() { return board_; }
  [[nodiscard]] Truth truth();
  /// How far what is shown is from what is: counts of the last read() over counts per unit, m or rad.
  [[nodiscard]] const std::array<double, bridge::kCounters>& shown_error() const { return shown_error_; }
  /// How far what the drives get is from what the bridge has written, V.
  [[nodiscard]] double output_error_v(std::size_t axis);

 private:
  const configuration::Rig& told_;
  simulator::SimulatedBoard board_;
  bridge::Outputs written_;
  std::array<double, bridge::kCounters> shown_error_{};
};

class FaultyBoard final : public bridge::Board {
 public:
  explicit FaultyBoard(std::shared_ptr<World> world) : world_{std::move(world)} {}
  [[nodiscard]] std::string_view name() const override { return "simulated, with faults"; }
  [[nodiscard]] bridge::Inputs read() override { return world_->read(); }
  std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs) override {
    return world_->write(outputs);
  }
  void make_safe() noexcept override { world_->make_safe(); }
  void advance_to(std::int64_t time_ns) override { world_->board().advance_to(time_ns); }
  [[nodiscard]] bool simulates_time() const override { return true; }
  bool kick(double radial_radps, double tangential_radps) override {
    return world_->board().kick(radial_radps, tangential_radps);
  }

 private:
  std::shared_ptr<World> world_;
};

}  // namespace crane::campaign
