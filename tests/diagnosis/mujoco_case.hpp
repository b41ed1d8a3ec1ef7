#pragma once
/// Sets of tests/truth_mujoco, diagnosed from their files alone and scored.
#include "score_record.hpp"

namespace crane::diagnosis::score {

/// Generates the set, diagnoses its files, and judges.
/// @throws std::runtime_error without Debian's libmujoco-dev
[[nodiscard]] Record scored_mujoco(std::size_t number, std::uint64_t deck_seed);
[[nodiscard]] std::string kind_of_mujoco(std::size_t number);

}  // namespace crane::diagnosis::score
