#pragma once
/// The files of a set.
#include <filesystem>
#include <string>

#include "set.hpp"

namespace mujoco_truth {

/// The rig file without its faults.
[[nodiscard]] std::string rig_toml(const Set& set);
/// Writes rig.toml, train_N.csv, test_N.csv, perhaps mapping.toml; truth.json goes to `truth`.
void write(const Set& set, const std::filesystem::path& directory, const std::filesystem::path& truth);

}  // namespace mujoco_truth
