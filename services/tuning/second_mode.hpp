#pragma once
/// Identifies the second mode of a load that hangs below a hook: the term double_pendulum of the rig file.
#include <optional>
#include <vector>

#include "tuning/identify.hpp"

namespace crane::tuning {

/// @return nothing when the load swings as a single pendulum: the residual of `load` is quantisation noise,
/// or a second mode does not explain this residual
/// @throws identification::IdentificationError
[[nodiscard]] std::optional<SecondMode> find_second_mode(const std::vector<diagnosis::PreparedRun>& runs,
                                                         const configuration::Rig& rig, const LoadFit& load);

}  // namespace crane::tuning
