#pragma once
/// Assignment of digital lines to signals, and initial counts of the encoders. All cards with counters and
/// digital lines use these functions.
#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

class RigLines {
 public:
  explicit RigLines(const configuration::Rig& rig);
  /// Sets all inputs except the counts. Inputs are contacts to ground that are closed in normal operation; a
  /// low line is a closed contact. @param levels  bit n: level of input line n, 0..15
  void read(std::uint32_t levels, Inputs& inputs) const noexcept;
  /// @return bit n is set when output line n, 16..31, is on; all other bits are 0
  [[nodiscard]] std::uint32_t outputs(const Outputs& outputs) const noexcept;
  [[nodiscard]] bool present(std::size_t drive) const { return present_[drive]; }

 private:
  configuration::Wiring wiring_;
  std::array<bool, kDrives> present_{};
};

/// Initial counts of the incremental encoders: those of [start] of the rig file; for an axis with homing
/// those of unhomed_position().
[[nodiscard]] std::array<std::int32_t, kCounters> start_counts(const configuration::Rig& rig);

}  // namespace crane::bridge
