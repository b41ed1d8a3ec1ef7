#pragma once
/// A simulated rig that implements the interface of a board: equations of motion with encoders, converters,
/// brakes, switches and watchdog relay.
///
/// Encoders: the raw count is the nearest integer of sign * (coordinate - zero) * counts_per_unit, wrapped to
/// 24 bits and sign-extended. A coordinate is 0 with the trolley at the tower axis, slew angle 0, cable
/// length 0, or the load at rest. The sensor terms of the model act once per time at which read()
/// is called: two reads at the same time return the same values.
///
/// Converters: see crane/bridge/converter.hpp. Drives: the voltage of the board, multiplied by the sign of
/// the drive; then the command terms, once per tick.
///
/// Brakes: a brake without supply closes. It is supplied when brake_release is set, the relay is closed, and
/// the emergency stop is released (or not wired to the brakes). After the closing time the brake decelerates
/// the axis by `brake_deceleration` until standstill. Then the axis is locked, independent of all forces,
/// until the brake opens.
///
/// Watchdog relay: initially open. It closes when the watchdog output has toggled for `watchdog_permit_s`
/// with at most `watchdog_timeout_s` between two changes. It opens when the output has not changed for
/// `watchdog_timeout_s`.
///
/// End stops: an axis that reaches an end stop stops at once (inelastic impact). It leaves the stop when its
/// acceleration points inwards; this is checked at least every 10 ms.
///
/// Deterministic: equal calls give equal bits.
#include <memory>

#include "crane/bridge/board.hpp"
#include "crane/plant/state.hpp"
#include "crane/simulator/integrator.hpp"
#include "crane/simulator/simulated_rig.hpp"

namespace crane::simulator {

/// @return the low 24 bits, sign-extended
[[nodiscard]] std::int32_t wrap_24_bit(std::int64_t counts) noexcept;

class SimulatedBoard final : public bridge::Board {
 public:
  /// Initial state: at rest at `rig.start`, brakes closed, relay open, time `start_time_ns`.
  /// @throws std::invalid_argument with all problems of the rig
  explicit SimulatedBoard(const SimulatedRig& rig, std::int64_t start_time_ns = 0,
                          const Tolerances& tolerances = {});
  ~SimulatedBoard() override;

  [[nodiscard]] std::string_view name() const override { return "simulated"; }
  [[nodiscard]] bridge::Inputs read() override;
  std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs) override;
  void make_safe() noexcept override;
  /// Integrates up to `time_ns`; no effect when `time_ns` <= now_ns().
  /// @throws std::runtime_error when the integration fails; now_ns() is then the end of the last integrated
  ///   span
  void advance_to(std::int64_t time_ns) override;
  [[nodiscard]] bool simulates_time() const override { return true; }
  /// Adds swing rates; a direction without swing is ignored. @return true
  bool kick(double radial_radps, double tangential_radps) override;

  /// Presses or releases the emergency stop.
  void press_estop(bool pressed) noexcept;

  /// Output voltages of the converters [V].
  [[nodiscard]] const std::array<double, bridge::kDrives>& converter_v() const noexcept;
  /// True state without sensor errors, for tests and pictures.
  [[nodiscard]] const plant::State& truth() const noexcept;
  [[nodiscard]] std::int64_t now_ns() const noexcept;

 private:
  struct Rig;
  std::unique_ptr<Rig> rig_;
};

}  // namespace crane::simulator
