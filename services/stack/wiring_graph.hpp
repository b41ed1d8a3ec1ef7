#pragma once
/// The wiring of a stack, generated from its ComponentSpecs: tables and a diagram for the documents, dot and
/// JSON for tools.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "crane/runtime/wiring.hpp"

namespace crane::stack {

/// All components that may be part of a stack: simulated plant, hardware bridge, loop, twin.
[[nodiscard]] std::vector<runtime::ComponentSpec> all_components();

/// Markdown: one line per topic with its type, writers, readers and quality of service.
[[nodiscard]] std::string wiring_table(const std::vector<runtime::ComponentSpec>& components);
/// Markdown: the topics that each component reads and writes, with the purpose.
[[nodiscard]] std::string component_table(const std::vector<runtime::ComponentSpec>& components);
/// Topics of a diagram.
enum class Extent {
  all,
  command_path  ///< the topics between a request and the volts
};
/// Mermaid flow chart: components are nodes, topics are arrows.
[[nodiscard]] std::string wiring_mermaid(const std::vector<runtime::ComponentSpec>& components,
                                         Extent extent = Extent::all);
/// The text of docs/wiring.md: the diagram of all topics and both tables.
[[nodiscard]] std::string wiring_document(const std::vector<runtime::ComponentSpec>& components);
/// Diagram for Graphviz.
[[nodiscard]] std::string wiring_dot(const std::vector<runtime::ComponentSpec>& components);
[[nodiscard]] nlohmann::ordered_json wiring_json(const std::vector<runtime::ComponentSpec>& components);

}  // namespace crane::stack
