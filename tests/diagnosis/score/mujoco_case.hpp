#pragma once
/// Diagnoses sets of tests/truth_mujoco from their files only, and scores the results.
#include "score/score_record.hpp"

namespace crane::diagnosis::score {

/// Generates the set, diagnoses its files, and judges.
/// @throws std::runtime_error without Debian's libmujoco-dev
[[nodiscard]] Record scored_mujoco(std::size_t number, std::uint64_t deck_seed);
[[nodiscard]] std::string kind_of_mujoco(std::size_t number);

}  // namespace crane::diagnosis::score
