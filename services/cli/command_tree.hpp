#pragma once
/// The commands as data, parsed from the text of --help, for shell completion and the manual page.
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace crane::cli {

struct CommandOption {
  std::vector<std::string> names;  ///< "--rig", "-h"; empty: a positional argument
  std::string argument;            ///< "TEXT", "FILE"; empty: a flag
  std::string meaning;
};
struct Command {
  std::string path;  ///< "crane topic echo"
  std::string meaning, footer;
  std::vector<CommandOption> options;
  std::vector<std::string> subcommands;
};

/// `root` and all its subcommands, in the order of --help.
[[nodiscard]] std::vector<Command> commands_of(const CLI::App& root);

/// Script that completes commands, options and, in all other places, file names.
[[nodiscard]] std::string bash_completion(const std::vector<Command>& commands);
[[nodiscard]] std::string zsh_completion(const std::vector<Command>& commands);
/// Page of section 1 (man-pages(7)).
[[nodiscard]] std::string man_page(const std::vector<Command>& commands, const std::string& version);

}  // namespace crane::cli
