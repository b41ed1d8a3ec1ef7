#include "cli/snapshot.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "crane/runtime/component.hpp"

namespace crane::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A snapshot with the status of these processes.
Snapshot heard(const std::vector<std::string>& names) {
  Snapshot snapshot;
  for (const auto& name : names) {
    msg::NodeStatus& node = snapshot.nodes[static_cast<std::uint32_t>(snapshot.nodes.size())];
    node = {};
    name.copy(node.name, sizeof node.name - 1);
  }
  return snapshot;
}

TEST(Snapshot, NamesEachProcessOfTheLoopThatHasSentNoStatus) {
  EXPECT_THAT(silent_processes(heard({"trajectory_planner", "tracking", "supervisor", "twin"})),
              ElementsAre("plant or hardware_bridge", "anti_swing", "friction_compensation"));
}

TEST(Snapshot, OfASimulatedAndOfARealCraneIsWhole) {
  for (const std::string plant : {"plant", "hardware_bridge"})
    EXPECT_THAT(silent_processes(heard({plant, "trajectory_planner", "tracking", "anti_swing",
                                        "friction_compensation", "supervisor"})),
                IsEmpty());
}

TEST(Snapshot, IsPrintedWithTheUnheardProcesses) {
  const Snapshot partial = heard({"plant", "trajectory_planner", "tracking", "anti_swing", "supervisor"});
  std::ostringstream text;
  print(text, partial);
  EXPECT_THAT(text.str(), HasSubstr("no status   friction_compensation: "));
  EXPECT_EQ(to_json(partial)["unheard"], nlohmann::json({"friction_compensation"}));
}

}  // namespace
}  // namespace crane::cli
