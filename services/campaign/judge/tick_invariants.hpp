#pragma once
/// Invariants that hold in every tick: I1, I4 to I7, and the parts of I2 and I8 that need no detection.
#include <string>

#include "campaign/judge/judge.hpp"

namespace crane::campaign {

/// Checks all rows of the run. Adds the violations and the largest distance beyond a limit to `verdict`.
void check_every_tick(const configuration::Rig& rig, const Run& run, Verdict& verdict);

/// Adds a violation at row `k`; without effect when `verdict` has a violation of this invariant.
void add_violation(const Run& run, Invariant invariant, std::size_t k, std::string what, Verdict& verdict);

}  // namespace crane::campaign
