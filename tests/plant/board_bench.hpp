#pragma once
/// The simulated board on the bench.
#include "crane/bridge/converter.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace crane::simulator {

using bridge::converter_code;
using bridge::converter_voltage_v;
using bridge::Inputs;
using bridge::Outputs;

inline constexpr std::int64_t kTick_ns = 10'000'000;

/// A board and the caller's side of its loop.
class Bench {
 public:
  explicit Bench(const SimulatedRig& rig = {}) : board(rig) {}

  /// Writes and lets ticks pass, toggling the watchdog output in each.
  void tick(const std::array<double, 3>& drive_v, bool release, int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      outputs.drive_v = drive_v;
      outputs.brake_release = {release, release, release};
      outputs.watchdog_level = !outputs.watchdog_level;
      applied_v = board.write(outputs);
      pass();
    }
  }
  /// Nobody writes.
  void pass(int ticks = 1) { board.advance_to(board.now_ns() + ticks * kTick_ns); }
  /// Relay closed, brakes open.
  void open_brakes() { tick({}, true, 12); }

  SimulatedBoard board;
  Outputs outputs;
  std::array<double, 3> applied_v{};
};

// --- converters
// -------------------------------------------------------------------------------------------------

}  // namespace crane::simulator
