#include "stack/data_files.hpp"

#include <algorithm>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "stack/child_processes.hpp"

#ifndef CRANE_DATA_DIRECTORY
#error "CRANE_DATA_DIRECTORY is set by the build"
#endif

namespace crane::stack {
namespace {

/// Directory of the data files: /usr/share/crane for installed programs, otherwise the source tree of the
/// build.
std::filesystem::path data_directory() {
  const auto installed = program_directory().parent_path() / "share/crane";
  return std::filesystem::is_directory(installed) ? installed : std::filesystem::path{CRANE_DATA_DIRECTORY};
}

std::filesystem::path locate(const std::string& what, const std::string& folder,
                             const std::string& name_or_path) {
  namespace fs = std::filesystem;
  if (fs::is_regular_file(name_or_path)) return fs::absolute(name_or_path).lexically_normal();
  const fs::path directory = data_directory() / folder;
  if (const auto known = directory / (name_or_path + ".toml"); fs::is_regular_file(known)) return known;
  std::vector<std::string> names;
  if (fs::is_directory(directory))
    for (const auto& entry : fs::directory_iterator{directory})
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  std::string known;
  for (const auto& name : names) known += (known.empty() ? "" : ", ") + name;
  throw configuration::ConfigurationError(
      {what + " = " + name_or_path + ": must be a file, or one of " + known});
}

}  // namespace

std::filesystem::path find_rig(const std::string& name_or_path) {
  return locate("rig", "rigs", name_or_path);
}

std::filesystem::path find_scenario(const std::string& name_or_path) {
  return locate("scenario", "scenarios", name_or_path);
}

std::filesystem::path find_sweep(const std::string& name_or_path) {
  return locate("sweep", "sweeps", name_or_path);
}

}  // namespace crane::stack
