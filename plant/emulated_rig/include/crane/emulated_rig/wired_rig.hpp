#pragma once
/// The simulated crane wired to the plugs of an emulated card as the rig file says: amplifiers and motors at
/// the converters, encoders at the counters, switches, brake and relay contacts at the inputs, brake supplies
/// and the watchdog relay at the outputs. Encoders are incremental: their pulses count from where the rig
/// stood at first.
#include "crane/boards/emulated_rig.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace crane::emulated_rig {

class WiredRig final : public bridge::EmulatedRig {
 public:
  /// @throws std::invalid_argument naming every problem of the rig
  explicit WiredRig(const configuration::Rig& rig);

  [[nodiscard]] std::int32_t pulses(std::size_t channel) noexcept override;
  [[nodiscard]] std::uint16_t inputs() noexcept override;
  void set_converter(std::size_t channel, std::uint16_t code) noexcept override;
  void set_outputs(std::uint16_t levels) noexcept override;
  [[nodiscard]] std::int64_t now_ns() noexcept override { return crane_.now_ns(); }
  [[nodiscard]] bridge::CardState& card() noexcept override { return card_; }
  /// @throws std::runtime_error when integration fails
  void advance_to(std::int64_t time_ns) override;
  void kick(double radial_radps, double tangential_radps) override {
    crane_.kick(radial_radps, tangential_radps);
  }
  void require_alive() override {}

  /// What no wire shows; for tests and measurements.
  [[nodiscard]] simulator::SimulatedBoard& crane() { return crane_; }
  /// Volts at the amplifiers.
  [[nodiscard]] const std::array<double, bridge::kDrives>& drive_v() const { return outputs_.drive_v; }

 private:
  std::array<configuration::Encoder, bridge::kCounters> encoders_;
  std::array<configuration::Drive, bridge::kDrives> drives_;
  configuration::Wiring wiring_;
  bridge::CardState card_;
  simulator::SimulatedBoard crane_;
  std::array<std::int32_t, bridge::kCounters> first_counts_;
  bridge::Outputs outputs_;
  bool changed_ = false;  ///< outputs that the crane has not been told yet
};

}  // namespace crane::emulated_rig
