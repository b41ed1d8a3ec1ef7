// The documents show the wiring that the components declare. The test prints the differences and the command
// that generates the text.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "crane/supervisor/modes.hpp"
#include "crane/supervisor/rules.hpp"
#include "stack/stack.hpp"
#include "stack/wiring_graph.hpp"

namespace crane::stack {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in{std::string{CRANE_SOURCE_DIRECTORY} + "/" + file};
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The text between "<!-- COMMAND -->" and "<!-- end -->".
std::string output_of(const std::string& command, const std::string& file) {
  const auto text = text_of(file);
  const auto begin = "<!-- " + command + " -->\n";
  const auto from = text.find(begin);
  if (from == std::string::npos) return "no " + begin + " in " + file;
  return text.substr(from + begin.size(), text.find("<!-- end -->", from) - from - begin.size());
}

TEST(Documents, ShowTheWiringAsTheComponentsDeclareIt) {
  const auto right = wiring_document(all_components());
  const auto copy = std::filesystem::path{testing::TempDir()} / "wiring.md";
  std::ofstream{copy} << right;
  EXPECT_EQ(text_of("docs/wiring.md"), right) << "put " << copy << " there";
}

TEST(Documents, ShowTheDiagramOfTheCommandPath) {
  EXPECT_EQ(output_of("crane graph --command-path", "README.md"),
            "```mermaid\n" + wiring_mermaid(all_components(), Extent::command_path) + "```\n")
      << "put the output of `crane graph --command-path` there";
}

TEST(Documents, ShowTheRulesThatTheSupervisorRuns) {
  EXPECT_EQ(output_of("crane supervisor explain", "docs/safety.md"), supervisor::rule_table())
      << "put the output of `crane supervisor explain` there";
}

TEST(Documents, ShowTheOperatingModes) {
  EXPECT_EQ(output_of("operating modes", "docs/safety.md"), supervisor::mode_table());
}

TEST(Wiring, GivesEveryLoopTopicOneWriterInAStack) {
  for (const auto plant : {Plant::simulated, Plant::hardware}) {
    const auto components = stack_with(plant);
    for (const auto& topic : topics::kAll) {
      if (!topic.every_tick || topic.name == topics::twin.description.name) continue;
      int writers = 0;
      for (const auto& component : components)
        for (const auto& write : component.writes)
          if (write.topic->name == topic.name) {
            ++writers;
            EXPECT_TRUE(topics::may_write(topic, component.source)) << component.name << ", " << topic.name;
          }
      EXPECT_EQ(writers, 1) << topic.name;
    }
  }
}

}  // namespace
}  // namespace crane::stack
