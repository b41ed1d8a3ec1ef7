#pragma once
/// The simulated rig, with faults between rig and bridge.
#include <functional>
#include <memory>

#include "campaign/judge/record.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace crane::campaign {

/// The simulated rig and its faults. It outlives the bridge.
class FaultyRig {
 public:
  /// @param configured  rig file of the stack. @param actual  parameters of the simulated rig
  FaultyRig(const configuration::Rig& configured, const configuration::Rig& actual);

  std::function<void(bridge::Inputs&)> change_inputs;    ///< fault between rig and bridge; empty: none
  std::function<void(bridge::Outputs&)> change_outputs;  ///< fault between bridge and rig; empty: none

  [[nodiscard]] bridge::Inputs read();
  std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs);
  void make_safe() noexcept;
  [[nodiscard]] simulator::SimulatedBoard& board() { return board_; }
  [[nodiscard]] Truth truth();
  /// Error of each counter in the last read(), m or rad.
  [[nodiscard]] const std::array<double, bridge::kCounters>& shown_error() const { return shown_error_; }
  /// Difference between the voltage at the drive and the voltage that the bridge has written, V.
  [[nodiscard]] double output_error_v(std::size_t axis);

 private:
  const configuration::Rig& configured_;
  simulator::SimulatedBoard board_;
  bridge::Outputs written_;
  std::array<double, bridge::kCounters> shown_error_{};
};

class FaultyBoard final : public bridge::Board {
 public:
  explicit FaultyBoard(std::shared_ptr<FaultyRig> rig) : rig_{std::move(rig)} {}
  [[nodiscard]] std::string_view name() const override { return "simulated, with faults"; }
  [[nodiscard]] bridge::Inputs read() override { return rig_->read(); }
  std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs) override {
    return rig_->write(outputs);
  }
  void make_safe() noexcept override { rig_->make_safe(); }
  void advance_to(std::int64_t time_ns) override { rig_->board().advance_to(time_ns); }
  [[nodiscard]] bool simulates_time() const override { return true; }
  bool kick(double radial_radps, double tangential_radps) override {
    return rig_->board().kick(radial_radps, tangential_radps);
  }

 private:
  std::shared_ptr<FaultyRig> rig_;
};

}  // namespace crane::campaign
