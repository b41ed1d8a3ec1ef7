#pragma once
/// The simulated board with a caller, for tests.
#include "crane/bridge/converter.hpp"
#include "crane/simulator/simulated_board.hpp"

namespace crane::simulator {

using bridge::converter_code;
using bridge::converter_voltage_v;
using bridge::Inputs;
using bridge::Outputs;

inline constexpr std::int64_t kTick_ns = 10'000'000;

/// A board and the loop that calls it.
class Bench {
 public:
  explicit Bench(const SimulatedRig& rig = {}) : board(rig) {}

  /// Writes outputs for several ticks and toggles the watchdog output in each tick.
  void tick(const std::array<double, 3>& drive_v, bool release, int ticks = 1) {
    for (int i = 0; i < ticks; ++i) {
      outputs.drive_v = drive_v;
      outputs.brake_release = {release, release, release};
      outputs.watchdog_level = !outputs.watchdog_level;
      applied_v = board.write(outputs);
      pass();
    }
  }
  /// Advances the time without writing.
  void pass(int ticks = 1) { board.advance_to(board.now_ns() + ticks * kTick_ns); }
  /// Closes the relay and opens the brakes.
  void open_brakes() { tick({}, true, 12); }

  SimulatedBoard board;
  Outputs outputs;
  std::array<double, 3> applied_v{};
};

}  // namespace crane::simulator
