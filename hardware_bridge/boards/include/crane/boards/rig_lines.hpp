#pragma once
/// What every card with counters and digital lines has in common: which line is which signal, and what the
/// counters begin with.
#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

class RigLines {
 public:
  explicit RigLines(const configuration::Rig& rig);
  /// Fills in everything but the counts. Inputs are contacts to ground, closed when all is well: a line that
  /// is low is closed. @param levels  bit n: line n of inputs 0..15
  void read(std::uint32_t levels, Inputs& inputs) const noexcept;
  /// Bit n: line n of outputs 16..31 is on; no others.
  [[nodiscard]] std::uint32_t outputs(const Outputs& outputs) const noexcept;
  [[nodiscard]] bool present(std::size_t drive) const { return present_[drive]; }

 private:
  configuration::Wiring wiring_;
  std::array<bool, kDrives> present_{};
};

/// Encoders are incremental: [start] of the rig file, or for an axis that is homed the end of its travel that
/// is farther from the mark.
[[nodiscard]] std::array<std::int32_t, kCounters> start_counts(const configuration::Rig& rig);

}  // namespace crane::bridge
