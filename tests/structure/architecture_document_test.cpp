// The links between the targets of the build obey the table of docs/architecture.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace crane {
namespace {

using Names = std::set<std::string>;

/// The links between the targets of the build, from the file that tests/structure/links.cmake writes.
struct Build {
  std::map<std::string, std::string> folder;  ///< by target
  std::map<std::string, Names> links;         ///< by target: targets and external libraries
};

Build read_build() {
  Build build;
  std::ifstream in{CRANE_LINKS};
  std::string target, folder, link;
  while (in >> target >> folder >> link) {
    if (folder.starts_with("tests")) continue;
    build.folder[target] = folder;
    build.links[target].insert(link);
  }
  return build;
}

/// All targets and libraries that `target` links, directly or indirectly.
Names linked_by(const Build& build, const std::string& target) {
  Names all;
  std::vector<std::string> open{target};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    const auto links = build.links.find(next);
    if (links == build.links.end()) continue;
    for (const std::string& link : links->second)
      if (all.insert(link).second) open.push_back(link);
  }
  return all;
}

std::vector<std::string> cells(const std::string& row) {
  std::vector<std::string> found;
  std::istringstream in{row.substr(1)};
  for (std::string cell; std::getline(in, cell, '|');) found.push_back(cell);
  return found;
}

/// Names in back quotes.
std::vector<std::string> quoted(const std::string& cell) {
  std::vector<std::string> found;
  const std::regex name{"`([a-z_/]+)`"};
  for (std::sregex_iterator it{cell.begin(), cell.end(), name}, end; it != end; ++it) {
    found.push_back((*it)[1]);
    if (found.back().ends_with('/')) found.back().pop_back();
  }
  return found;
}

/// Folders of the table "Folders", each with those that it may use.
class Table {
 public:
  Table() {
    std::ifstream in{std::string{CRANE_SOURCE_DIRECTORY} + "/docs/architecture.md"};
    std::map<std::string, std::string> rows;
    for (std::string line; std::getline(in, line) && !line.starts_with("## Component");)
      if (line.starts_with("| `")) {
        const auto columns = cells(line);
        for (const std::string& folder : quoted(columns.at(0))) rows[folder] = columns.at(2);
      }
    for (const auto& [folder, uses] : rows) may_use_[folder];
    for (const auto& [folder, uses] : rows) {
      if (uses.find("all of the above") != std::string::npos)
        for (const auto& [other, unused] : rows) may_use_[folder].insert(other);
      for (const std::string& name : quoted(uses)) may_use_[folder].insert(folder_named(name));
    }
  }

  [[nodiscard]] bool has(const std::string& folder) const { return may_use_.contains(folder); }

  /// The row of a folder: the row of the folder itself, of its nearest parent, or "process".
  [[nodiscard]] std::string row_of(std::string folder) const {
    while (!may_use_.contains(folder) && folder.find('/') != std::string::npos)
      folder.resize(folder.rfind('/'));
    return folder;
  }

  /// True when the row permits the use, directly or through the folders that it permits.
  [[nodiscard]] bool permits(const std::string& from, const std::string& to) const {
    Names reached;
    std::vector<std::string> open{from};
    while (!open.empty()) {
      const std::string next = open.back();
      open.pop_back();
      const auto row = may_use_.find(next);
      if (!reached.insert(next).second || row == may_use_.end()) continue;
      open.insert(open.end(), row->second.begin(), row->second.end());
    }
    return reached.contains(to);
  }

  [[nodiscard]] const std::map<std::string, Names>& rows() const { return may_use_; }

 private:
  /// "control" is libs/control.
  [[nodiscard]] std::string folder_named(const std::string& name) const {
    return may_use_.contains(name) || !may_use_.contains("libs/" + name) ? name : "libs/" + name;
  }

  std::map<std::string, Names> may_use_;
};

bool is_process(const std::string& folder) { return folder.ends_with("/process"); }
std::string without_process(const std::string& folder) {
  return is_process(folder) ? folder.substr(0, folder.rfind('/')) : folder;
}

class Architecture : public testing::Test {
 protected:
  Build build_ = read_build();
  Table table_;
};

TEST_F(Architecture, TableHasARowForTheFolderOfEveryTarget) {
  ASSERT_GT(build_.folder.size(), 40U) << "are the links written?";
  for (const auto& [target, folder] : build_.folder)
    EXPECT_TRUE(table_.has(table_.row_of(folder))) << target << " in " << folder;
}

TEST_F(Architecture, TableNamesFoldersOfTheTree) {
  for (const auto& [folder, uses] : table_.rows()) {
    EXPECT_TRUE(std::filesystem::is_directory(std::string{CRANE_SOURCE_DIRECTORY} + '/' + folder)) << folder;
    for (const std::string& use : uses) EXPECT_TRUE(table_.has(use)) << folder << " may use " << use;
  }
}

/// A process (folder `process`) may use what its logic may use, and libs/runtime.
TEST_F(Architecture, FoldersUseOnlyWhatTheTablePermits) {
  for (const auto& [target, links] : build_.links)
    for (const std::string& link : links) {
      if (!build_.folder.contains(link)) continue;
      const std::string& from = build_.folder.at(target);
      const std::string to = table_.row_of(without_process(build_.folder.at(link)));
      const bool permitted = table_.permits(table_.row_of(without_process(from)), to) ||
                             (is_process(from) && table_.permits("libs/runtime", to));
      EXPECT_TRUE(permitted) << target << " (" << from << ") links " << link << " (" << to << ')';
    }
}

TEST_F(Architecture, TargetsHaveNoCycles) {
  for (const auto& [target, folder] : build_.folder)
    EXPECT_FALSE(linked_by(build_, target).contains(target)) << target;
}

TEST_F(Architecture, ProgramsThatDriveARealCraneLinkNoSimulator) {
  const Names programs{
      "crane_hardware_bridge_process", "crane_trajectory_planner_process",    "crane_tracking_process",
      "crane_anti_swing_process",      "crane_friction_compensation_process", "crane_supervisor_process"};
  for (const std::string& program : programs) {
    const Names linked = linked_by(build_, program);
    EXPECT_TRUE(linked.contains("crane_runtime")) << program;
    for (const std::string& link : linked) {
      const auto folder = build_.folder.find(link);
      if (folder == build_.folder.end() || !folder->second.starts_with("plant/")) continue;
      EXPECT_EQ(folder->second, "plant/model") << program << " links " << link;
    }
  }
  EXPECT_TRUE(linked_by(build_, "crane_hardware_bridge_process").contains("crane_boards"));
}

TEST_F(Architecture, PureLibrariesLinkNoMessagesAndNoDds) {
  for (const char* target : {"crane_control", "crane_analysis", "crane_plant_model", "crane_supervisor_logic",
                             "crane_identification"}) {
    ASSERT_TRUE(build_.folder.contains(target)) << target;
    for (const std::string& link : linked_by(build_, target)) {
      EXPECT_NE(link, "crane_idl") << target;
      EXPECT_EQ(link.find("CycloneDDS"), std::string::npos) << target << " links " << link;
      EXPECT_EQ(link.find("fastrtps"), std::string::npos) << target << " links " << link;
    }
  }
}

}  // namespace
}  // namespace crane
