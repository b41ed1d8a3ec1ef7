#pragma once
/// Encoders that lose counts. The position jumps between two rows by more than the drive can move in this
/// time, while the motion continues; no force explains such a jump.
#include <cstddef>
#include <vector>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

/// Lost counts of a drive's encoder.
struct LosingEncoder {
  Output axis = kTrolleyPosition;
  std::size_t jumps = 0;              ///< in `duration_s`
  double duration_s = 0, lost = 0;    ///< lost: total loss with sign, m or rad
  double jump = 0, jump_std_dev = 0;  ///< median size, m or rad, > 0
  double rate = 0, rate_std_dev = 0;  ///< lost per distance, m/m or rad/rad
};

/// Encoders with at least kFewestClearJumps clear jumps.
[[nodiscard]] std::vector<LosingEncoder> losing_encoders(const std::vector<Run>& runs,
                                                         const configuration::Rig& rig);

/// The runs with the jumps of these encoders removed.
[[nodiscard]] std::vector<Run> without_count_losses(std::vector<Run> runs,
                                                    const std::vector<LosingEncoder>& losing,
                                                    const configuration::Rig& rig);

}  // namespace crane::diagnosis
