#pragma once
/// Encoders that lose counts. What they show jumps from one row to the next while the motion goes on as
/// before, by more than its drive can slip in that time: no force does that.
#include <cstddef>
#include <vector>

#include "crane/diagnosis/data.hpp"

namespace crane::diagnosis {

/// The encoder of a drive that loses counts.
struct LosingEncoder {
  Output axis = kTrolleyPosition;
  std::size_t jumps = 0;              ///< in `duration_s`
  double duration_s = 0, lost = 0;    ///< lost: in all, m or rad, with its sign
  double jump = 0, jump_std_dev = 0;  ///< usual size of one, m or rad, > 0
  double rate = 0, rate_std_dev = 0;  ///< lost per way, m/m or rad/rad
};

/// Those of which at least five jumps are clear.
[[nodiscard]] std::vector<LosingEncoder> losing_encoders(const std::vector<Run>& runs,
                                                         const configuration::Rig& rig);

/// The runs with what those encoders lost put back: a position goes on where it was.
[[nodiscard]] std::vector<Run> put_back(std::vector<Run> runs, const std::vector<LosingEncoder>& losing,
                                        const configuration::Rig& rig);

}  // namespace crane::diagnosis
