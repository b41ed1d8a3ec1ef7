#pragma once
/// The simulated crane, connected to an emulated card according to the rig file: amplifiers and motors to the
/// converters, encoders to the counters, switches, brake and relay contacts to the inputs, brake supplies and
/// watchdog relay to the outputs. The encoders are incremental; their pulses count from the initial position.
#include "crane/boards/emulated_rig.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace crane::emulated_rig {

class WiredRig final : public bridge::EmulatedRig {
 public:
  /// @throws std::invalid_argument with all problems of the rig
  explicit WiredRig(const configuration::Rig& rig);

  [[nodiscard]] std::int32_t pulses(std::size_t channel) noexcept override;
  [[nodiscard]] std::uint16_t inputs() noexcept override;
  void set_converter(std::size_t channel, std::uint16_t code) noexcept override;
  void set_outputs(std::uint16_t levels) noexcept override;
  [[nodiscard]] std::int64_t now_ns() noexcept override { return crane_.now_ns(); }
  [[nodiscard]] bridge::CardState& card() noexcept override { return card_; }
  /// @param faults  sum of bridge::CardFault
  void inject(std::uint32_t faults) noexcept { faults_ = faults; }
  /// @throws std::runtime_error when the integration fails
  void advance_to(std::int64_t time_ns) override;
  void kick(double radial_radps, double tangential_radps) override {
    crane_.kick(radial_radps, tangential_radps);
  }
  void require_alive() override {}

  /// The simulated board, for tests and measurements.
  [[nodiscard]] simulator::SimulatedBoard& crane() { return crane_; }
  /// Voltages at the amplifiers.
  [[nodiscard]] const std::array<double, bridge::kDrives>& drive_v() const { return outputs_.drive_v; }

 private:
  std::array<configuration::Encoder, bridge::kCounters> encoders_;
  std::array<configuration::Drive, bridge::kDrives> drives_;
  configuration::Wiring wiring_;
  bridge::CardState card_;
  simulator::SimulatedBoard crane_;
  std::array<std::int32_t, bridge::kCounters> first_counts_;
  bridge::Outputs outputs_;
  std::uint32_t faults_ = 0;
  bool changed_ = false;  ///< true: outputs_ was not yet written to the crane
};

}  // namespace crane::emulated_rig
