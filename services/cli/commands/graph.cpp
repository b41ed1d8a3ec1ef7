/// crane graph: the wiring of a stack according to the declarations of its components.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/commands/commands.hpp"
#include "stack/wiring_graph.hpp"

namespace crane::cli {
namespace {

int draw(const std::string& format, stack::Extent extent) {
  const auto components = stack::all_components();
  if (format == "mermaid") std::cout << stack::wiring_mermaid(components, extent);
  if (format == "markdown") std::cout << stack::wiring_document(components);
  if (format == "dot") std::cout << stack::wiring_dot(components);
  if (format == "json") std::cout << stack::wiring_json(components).dump(2) << '\n';
  if (format == "topics") std::cout << stack::wiring_table(components);
  if (format == "components") std::cout << stack::component_table(components);
  return runtime::kExitDone;
}

}  // namespace

void add_graph(CLI::App& app, Action& chosen) {
  auto format = std::make_shared<std::string>("mermaid");
  auto* command =
      app.add_subcommand("graph", "Show the topics that each process reads and writes, with their purpose");
  command
      ->add_option(
          "--format", *format,
          "mermaid or dot: a diagram; topics or components: a table; markdown: the page docs/wiring.md; "
          "json: for other programs")
      ->check(CLI::IsMember({"mermaid", "dot", "json", "topics", "components", "markdown"}))
      ->capture_default_str();
  auto command_path = std::make_shared<bool>(false);
  command->add_flag("--command-path", *command_path,
                    "mermaid: only the topics between a request and the drive voltages");
  command->footer("Example: crane graph --format dot | dot -Tsvg > wiring.svg");
  command->callback([format, command_path, &chosen] {
    chosen = [format, command_path] {
      return draw(*format, *command_path ? stack::Extent::command_path : stack::Extent::all);
    };
  });
}

}  // namespace crane::cli
