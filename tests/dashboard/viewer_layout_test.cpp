// The layout for Foxglove and Lichtblick names channels of the dashboard and fields of the IDL, and shows
// each of its panels once.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dashboard/foxglove.hpp"
#include "observation/field_table.hpp"

namespace crane::dashboard {
namespace {

nlohmann::json layout() {
  std::ifstream file{CRANE_VIEWER_LAYOUT};
  return nlohmann::json::parse(file);
}

/// "/crane/state.applied_v[0]": the name of a channel, then that of a field.
struct MessagePath {
  explicit MessagePath(const std::string& text)
      : channel{text.substr(0, text.find('.'))},
        field{channel.size() < text.size() ? text.substr(channel.size() + 1) : ""} {}
  std::string channel, field;
};

bool is_channel(const std::string& name) {
  return std::ranges::any_of(channels(), [&](const Channel& channel) { return channel.topic == name; });
}

/// Texts of all panels in a node of the layout: a panel, or two nodes.
void list_panels(const nlohmann::json& node, std::map<std::string, int>& panels) {
  if (node.is_string()) {
    ++panels[node.get<std::string>()];
    return;
  }
  EXPECT_TRUE(node.at("direction") == "row" || node.at("direction") == "column");
  list_panels(node.at("first"), panels);
  list_panels(node.at("second"), panels);
}

TEST(ViewerLayout, PlotsNumbersOfTheTopics) {
  const observation::FieldTable fields;
  std::size_t paths = 0;
  const auto json = layout();
  for (const auto& [panel, config] : json.at("configById").items()) {
    if (!config.contains("paths")) continue;
    ASSERT_FALSE(config.at("paths").empty()) << panel;
    for (const auto& path : config.at("paths")) {
      const MessagePath named{path.at("value").get<std::string>()};
      EXPECT_TRUE(is_channel(named.channel)) << panel << ": " << named.channel;
      const auto name = named.channel.substr(1) + "." + named.field;
      EXPECT_TRUE(fields.find(name)) << panel << ": " << name << ": " << fields.explain(name);
      ++paths;
    }
  }
  EXPECT_GT(paths, 20U);
}

TEST(ViewerLayout, ShowsMessagesOfTheTopics) {
  const observation::FieldTable fields;
  std::size_t messages = 0;
  const auto json = layout();
  for (const auto& [panel, config] : json.at("configById").items()) {
    if (!config.contains("topicPath")) continue;
    const MessagePath named{config.at("topicPath").get<std::string>()};
    EXPECT_TRUE(is_channel(named.channel)) << panel << ": " << named.channel;
    ++messages;
    if (named.field.empty()) continue;
    const auto is_part = [&](const recording::LeafType& leaf) {
      return leaf.name.starts_with(named.field + ".");
    };
    const auto topic =
        std::ranges::find(fields.topics(), named.channel.substr(1), &observation::TopicFields::name);
    ASSERT_NE(topic, fields.topics().end()) << panel;
    EXPECT_TRUE(std::ranges::any_of(topic->leaves, is_part)) << panel << ": " << named.field;
  }
  EXPECT_EQ(messages, 2U);
}

TEST(ViewerLayout, ShowsEachPanelOnce) {
  const auto json = layout();
  std::map<std::string, int> shown;
  list_panels(json.at("layout"), shown);
  for (const auto& [panel, times] : shown) EXPECT_EQ(times, 1) << panel;
  EXPECT_EQ(shown.size(), json.at("configById").size());
  for (const auto& [panel, config] : json.at("configById").items())
    EXPECT_TRUE(shown.contains(panel)) << panel;
}

}  // namespace
}  // namespace crane::dashboard
