/// crane completion, crane man: the commands and options of --help, for the shell and as a manual page.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/command_tree.hpp"
#include "commands.hpp"

namespace crane::cli {

void add_completion(CLI::App& app, Action& chosen) {
  auto shell = std::make_shared<std::string>();
  auto* command =
      app.add_subcommand("completion", "Print a script that completes commands and options in a shell");
  command->add_option("SHELL", *shell, "bash or zsh")->required()->check(CLI::IsMember({"bash", "zsh"}));
  command->footer(
      "Examples: source <(crane completion bash)\n"
      "          crane completion zsh > ~/.zfunc/_crane");
  command->callback([shell, &app, &chosen] {
    chosen = [shell, &app] {
      const auto commands = commands_of(app);
      std::cout << (*shell == "bash" ? bash_completion(commands) : zsh_completion(commands));
      return runtime::kExitDone;
    };
  });
}

void add_man(CLI::App& app, Action& chosen) {
  auto* command = app.add_subcommand("man", "Print the manual page of all commands");
  command->footer("Example: crane man | man -l -");
  command->callback([&app, &chosen] {
    chosen = [&app] {
      std::cout << man_page(commands_of(app), CRANE_VERSION);
      return runtime::kExitDone;
    };
  });
}

}  // namespace crane::cli
