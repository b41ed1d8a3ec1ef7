#pragma once
/// The files of a set.
#include <filesystem>
#include <string>

#include "set.hpp"

namespace mujoco_truth {

/// The rig file of a set, without the faults.
[[nodiscard]] std::string rig_toml(const Set& set);
/// Writes rig.toml, train_N.csv, test_N.csv, mapping.toml if the columns are foreign, and the answer to the
/// file `truth`.
void write(const Set& set, const std::filesystem::path& directory, const std::filesystem::path& truth);

}  // namespace mujoco_truth
