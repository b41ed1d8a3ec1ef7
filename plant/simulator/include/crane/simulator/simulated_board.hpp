#pragma once
/// A rig that exists in memory only, behind the interface of a real board: encoders, converters, brakes,
/// switches and the watchdog relay around the equations of motion.
///
/// Encoders: raw counts are absolute, nearest integer of sign * coordinate * counts_per_unit with coordinate
///   0 at the rig's zero (tower axis, slew zero, no cable, hanging load), wrapped to 24 bits and
///   sign-extended. The coordinate is what the model's sensor terms make of it, once for each time that is
///   read.
/// Converters: see crane/bridge/converter.hpp.
/// Drives: the board's voltage times the drive's sign, then the model's command terms, once a tick.
/// Brakes: closed without supply. Supply = brake_release and relay closed and (e-stop released or not wired
/// in).
///   After the closing time a brake is dry friction of `brake_deceleration` until standstill, then the axis
///   is locked exactly, whatever pulls at it, until the brake has opened.
/// Watchdog relay: open at start. It closes when the watchdog output has changed at least every
///   `watchdog_timeout_s` for `watchdog_permit_s`, drops when it has not changed for longer than
///   `watchdog_timeout_s` of rig time, and then stays dropped until it may close again by the same rule.
/// End stops: the axis is stopped dead; it leaves when its acceleration points inwards (looked at every 10 ms
/// or
///   less).
/// Deterministic: the same calls give the same bits.
#include <memory>

#include "crane/bridge/board.hpp"
#include "crane/plant/state.hpp"
#include "crane/simulator/integrator.hpp"
#include "crane/simulator/simulated_rig.hpp"

namespace crane::simulator {

/// Low 24 bits, sign-extended.
[[nodiscard]] std::int32_t wrap_24_bit(std::int64_t counts) noexcept;

class SimulatedBoard final : public bridge::Board {
 public:
  /// The rig rests at its start with brakes closed and relay open; its clock shows `start_time_ns`.
  /// @throws std::invalid_argument naming every problem of the rig
  explicit SimulatedBoard(const SimulatedRig& rig, std::int64_t start_time_ns = 0,
                          const Tolerances& tolerances = {});
  ~SimulatedBoard() override;

  [[nodiscard]] std::string_view name() const override { return "simulated"; }
  [[nodiscard]] bridge::Inputs read() override;
  std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs) override;
  void make_safe() noexcept override;
  /// Integrates to `time_ns`; nothing happens when that is not later than now().
  /// @throws std::runtime_error when integration fails; the rig then stays where it was
  void advance_to(std::int64_t time_ns) override;
  [[nodiscard]] bool simulates_time() const override { return true; }
  /// Ways the cable cannot swing are left out. @return true
  bool kick(double radial_radps, double tangential_radps) override;

  /// The emergency stop button.
  void press_estop(bool pressed) noexcept;

  /// Volts that the converters give.
  [[nodiscard]] const std::array<double, bridge::kDrives>& converter_v() const noexcept;
  /// What no sensor knows; for tests and pictures.
  [[nodiscard]] const plant::State& truth() const noexcept;
  [[nodiscard]] std::int64_t now_ns() const noexcept;

 private:
  struct Rig;
  std::unique_ptr<Rig> rig_;
};

}  // namespace crane::simulator
