#include "stack/wiring_graph.hpp"

#include <algorithm>

#include "crane/bridge/component.hpp"
#include "crane/twin/component.hpp"
#include "stack/stack.hpp"

namespace crane::stack {
namespace {

using runtime::ComponentSpec;
using runtime::Write;
using topics::Description;

constexpr const char* kOperator = "operator tools";
constexpr const char* kEveryProcess = "every process";

std::string joined(const std::vector<std::string>& parts, const std::string& separator) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

bool names(const Description* listed, const Description& topic) { return listed->name == topic.name; }

/// True for topics that every process and every tool may use without a declaration in a ComponentSpec.
bool is_undeclared(const Description& topic) {
  return names(&topics::node.description, topic) || names(&topics::event.description, topic);
}

/// Remark behind the name of a writer; empty when the component always writes the topic.
std::string condition_of(const Write& write) {
  return write.written_with == nullptr ? "" : " (some rig files)";
}

std::vector<std::string> writers_of(const std::vector<ComponentSpec>& components, const Description& topic) {
  if (is_undeclared(topic)) return {kEveryProcess};
  if (topics::may_write(topic, crane_SOURCE_OPERATOR)) return {kOperator};
  std::vector<std::string> writers;
  for (const auto& component : components)
    for (const auto& write : component.writes)
      if (names(write.topic, topic)) writers.push_back(std::string{component.name} + condition_of(write));
  return writers;
}

std::vector<std::string> readers_of(const std::vector<ComponentSpec>& components, const Description& topic) {
  std::vector<std::string> readers;
  for (const auto& component : components)
    for (const auto& read : component.reads)
      if (names(read.topic, topic))
        readers.push_back(std::string{component.name} +
                          (read.needed_by == nullptr ? "" : " (some controllers)"));
  if (names(&topics::reply.description, topic)) readers.emplace_back(kOperator);
  readers.emplace_back("monitors");
  return readers;
}

std::string_view name_of(topics::Qos qos) {
  switch (qos) {
    case topics::Qos::loop:
      return "loop";
    case topics::Qos::script:
      return "script";
    case topics::Qos::status:
      return "status";
    case topics::Qos::log:
      return "log";
  }
  return "";
}

/// True for a topic between a request and the drive voltages, as in the diagram of the README.
bool is_on_command_path(const Description& topic) {
  return std::ranges::any_of(
      std::array{&topics::request.description, &topics::jog.description, &topics::supervisor.description,
                 &topics::reference.description, &topics::state.description, &topics::tracking.description,
                 &topics::anti_swing.description, &topics::demand.description, &topics::command.description},
      [&topic](const Description* listed) { return names(listed, topic); });
}

/// Short name of a topic: "crane/anti_swing" -> "anti_swing".
std::string short_name(const Description& topic) {
  const std::string name{topic.name};
  return name.substr(name.find('/') + 1);
}

struct Arrow {
  std::string from, to, topic;
};

/// Name of the node; simulated plant and hardware bridge share the node of the clock master.
std::string node_of(std::string_view component) {
  return component == "hardware_bridge" ? "plant" : std::string{component};
}

std::vector<Arrow> arrows_of(const std::vector<ComponentSpec>& components, Extent extent) {
  std::vector<Arrow> arrows;
  const auto add = [&arrows](Arrow arrow) {
    const bool known = std::ranges::any_of(arrows, [&](const Arrow& other) {
      return other.from == arrow.from && other.to == arrow.to && other.topic == arrow.topic;
    });
    if (!known) arrows.push_back(std::move(arrow));
  };
  for (const auto& reader : components)
    for (const auto& read : reader.reads) {
      if (extent == Extent::command_path && !is_on_command_path(*read.topic)) continue;
      if (topics::may_write(*read.topic, crane_SOURCE_OPERATOR))
        add({"operator", node_of(reader.name), short_name(*read.topic)});
      for (const auto& writer : components)
        for (const auto& write : writer.writes)
          if (names(write.topic, *read.topic))
            add({node_of(writer.name), node_of(reader.name), short_name(*read.topic)});
    }
  return arrows;
}

}  // namespace

std::vector<ComponentSpec> all_components() {
  auto components = simulated_stack();
  components.insert(components.begin() + 1, bridge::hardware_bridge_spec());
  components.push_back(twin::twin_spec());
  return components;
}

std::string wiring_table(const std::vector<ComponentSpec>& components) {
  std::string table = "| topic | type | written by | read by | quality of service |\n|---|---|---|---|---|\n";
  for (const auto& topic : topics::kAll) {
    const std::string type{topic.type.substr(topic.type.rfind(':') + 1)};
    table += "| `" + std::string{topic.name} + "` | " + type + " | " +
             joined(writers_of(components, topic), topic.every_tick ? " **or** " : ", ") + " | " +
             joined(readers_of(components, topic), ", ") + " | " + std::string{name_of(topic.qos)} + " |\n";
  }
  return table;
}

std::string component_table(const std::vector<ComponentSpec>& components) {
  std::string table = "| component | reads | writes |\n|---|---|---|\n";
  for (const auto& component : components) {
    std::vector<std::string> reads, writes;
    for (const auto& read : component.reads)
      reads.push_back(short_name(*read.topic) + ": " + std::string{read.purpose} +
                      (read.needed_by == nullptr ? "" : " (some controllers)"));
    for (const auto& write : component.writes)
      writes.push_back(short_name(*write.topic) + ": " + std::string{write.purpose} + condition_of(write));
    table += "| `" + std::string{component.name} + "` | " + joined(reads, "<br>") + " | " +
             joined(writes, "<br>") + " |\n";
  }
  return table;
}

std::string wiring_mermaid(const std::vector<ComponentSpec>& components, Extent extent) {
  std::string chart =
      "flowchart LR\n  plant[\"plant or hardware_bridge<br/>(clock master)\"]\n  operator((operator "
      "tools))\n";
  for (const auto& arrow : arrows_of(components, extent))
    chart += "  " + arrow.from + " -- " + arrow.topic + " --> " + arrow.to + "\n";
  return chart;
}

std::string wiring_document(const std::vector<ComponentSpec>& components) {
  return "<!-- crane graph --format markdown > docs/wiring.md -->\n"
         "# Wiring\n\n"
         "Every component declares the topics that it reads and writes (`ComponentSpec`). This page is "
         "generated "
         "from "
         "these declarations;\na test fails when the page differs.\n\n"
         "## Diagram\n\n```mermaid\n" +
         wiring_mermaid(components) +
         "```\n\n"
         "## Topics\n\n\"Monitors\" are the recorder and the tools. They may read every topic. They write no "
         "topic "
         "of the control loop.\n[idl/README.md](../idl/README.md) explains the qualities of service.\n\n" +
         wiring_table(components) +
         "\n## Components\n\nEvery component also writes `crane/node` and `crane/event`.\n\n" +
         component_table(components);
}

std::string wiring_dot(const std::vector<ComponentSpec>& components) {
  std::string graph =
      "digraph crane {\n  rankdir=LR;\n  plant [label=\"plant or hardware_bridge\\n(clock master)\"];\n";
  for (const auto& arrow : arrows_of(components, Extent::all))
    graph += "  " + arrow.from + " -> " + arrow.to + " [label=\"" + arrow.topic + "\"];\n";
  return graph + "}\n";
}

nlohmann::ordered_json wiring_json(const std::vector<ComponentSpec>& components) {
  auto result = nlohmann::ordered_json::array();
  for (const auto& component : components) {
    auto reads = nlohmann::ordered_json::array(), writes = nlohmann::ordered_json::array();
    for (const auto& read : component.reads)
      reads.push_back({{"topic", read.topic->name},
                       {"purpose", read.purpose},
                       {"all_controllers", read.needed_by == nullptr}});
    for (const auto& write : component.writes)
      writes.push_back({{"topic", write.topic->name},
                        {"purpose", write.purpose},
                        {"all_rig_files", write.written_with == nullptr}});
    result.push_back({{"component", component.name},
                      {"program", component.program},
                      {"summary", component.summary},
                      {"reads", reads},
                      {"writes", writes}});
  }
  return result;
}

}  // namespace crane::stack
