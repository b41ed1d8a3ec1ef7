#include "cli/command_tree.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace crane::cli {
namespace {

CommandOption option_of(const CLI::Option& option) {
  CommandOption result{.names = {}, .argument = "", .meaning = option.get_description()};
  for (const auto& name : option.get_snames()) result.names.push_back("-" + name);
  for (const auto& name : option.get_lnames()) result.names.push_back("--" + name);
  const bool flag = option.get_items_expected_max() == 0;
  if (result.names.empty())
    result.argument = option.get_name(true);
  else if (!flag)
    result.argument = option.get_type_name().empty() ? "VALUE" : option.get_type_name();
  if (const auto& preset = option.get_default_str(); !flag && !preset.empty())
    result.meaning += " (default: " + preset + ")";
  return result;
}

void add(std::vector<Command>& commands, const CLI::App& app, const std::string& path) {
  Command command{.path = path,
                  .meaning = app.get_description(),
                  .footer = app.get_footer(),
                  .options = {},
                  .subcommands = {}};
  for (const auto* option : app.get_options())
    if (!option->get_group().empty()) command.options.push_back(option_of(*option));
  const auto all = [](const CLI::App*) { return true; };
  const auto below = app.get_subcommands(all);
  for (const auto* one : below) command.subcommands.push_back(one->get_name());
  commands.push_back(std::move(command));
  for (const auto* one : below) add(commands, *one, path + " " + one->get_name());
}

/// Subcommands and long options, separated by spaces.
std::string words_of(const Command& command) {
  std::string words;
  const auto add_word = [&words](const std::string& word) { words += (words.empty() ? "" : " ") + word; };
  for (const auto& name : command.subcommands) add_word(name);
  for (const auto& option : command.options)
    for (const auto& name : option.names)
      if (name.starts_with("--")) add_word(name);
  return words;
}

/// Escapes text for troff: no line begins with a control character, and '-' and '\' are printed literally.
std::string troff(const std::string& text) {
  std::string result;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
    line_begins = c == '\n';
  }
  return result;
}

}  // namespace

std::vector<Command> commands_of(const CLI::App& root) {
  std::vector<Command> commands;
  add(commands, root, root.get_name());
  return commands;
}

std::string bash_completion(const std::vector<Command>& commands) {
  std::string script =
      "# bash completion for crane; made by `crane completion bash`\n"
      "declare -A _crane_words=(\n";
  for (const auto& command : commands)
    script += "  [\"" + command.path + "\"]=\"" + words_of(command) + "\"\n";
  script +=
      ")\n"
      "_crane() {\n"
      "  local at=crane word\n"
      "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
      "    [[ -n \"${_crane_words[\"$at $word\"]+there}\" ]] && at=\"$at $word\"\n"
      "  done\n"
      "  COMPREPLY=($(compgen -W \"${_crane_words[\"$at\"]}\" -- \"${COMP_WORDS[COMP_CWORD]}\"))\n"
      "}\n"
      "complete -o default -F _crane crane\n";
  return script;
}

std::string zsh_completion(const std::vector<Command>& commands) {
  std::string script =
      "#compdef crane\n"
      "# zsh completion for crane; made by `crane completion zsh`\n"
      "typeset -gA _crane_words=(\n";
  for (const auto& command : commands) script += "  '" + command.path + "' '" + words_of(command) + "'\n";
  script +=
      ")\n"
      "_crane() {\n"
      "  local at=crane word\n"
      "  for word in ${words[2,CURRENT-1]}; do\n"
      "    (( ${+_crane_words[$at $word]} )) && at=\"$at $word\"\n"
      "  done\n"
      "  compadd -- ${=_crane_words[$at]}\n"
      "  _files\n"
      "}\n"
      "(( ${+functions[compdef]} )) && compdef _crane crane\n";
  return script;
}

std::string man_page(const std::vector<Command>& commands, const std::string& version) {
  const auto& root = commands.front();
  std::string page = ".TH CRANE 1 \"\" \"crane " + version +
                     "\" \"Crane control\"\n.ad l\n.SH NAME\ncrane \\- " + troff(root.meaning) +
                     "\n.SH SYNOPSIS\n.B crane\n.I COMMAND\n[\\fIOPTION\\fR ...]\n.SH DESCRIPTION\n.nf\n" +
                     troff(root.footer) + "\n.fi\n.SH COMMANDS\n";
  for (const auto& command : commands) {
    if (&command == &root) continue;
    page += ".SS " + troff(command.path) + "\n" + troff(command.meaning) + "\n";
    for (const auto& option : command.options) {
      std::string names;
      for (const auto& name : option.names) names += (names.empty() ? "" : ", ") + name;
      page +=
          ".TP\n\\fB" + troff(names) + "\\fR" +
          (option.argument.empty() ? ""
                                   : (names.empty() ? "\\fI" : " \\fI") + troff(option.argument) + "\\fR") +
          "\n" + troff(option.meaning) + "\n";
    }
    if (!command.footer.empty()) page += ".PP\n.nf\n" + troff(command.footer) + "\n.fi\n";
  }
  return page + ".SH EXIT STATUS\n0: done. 1: failed. 2: bad arguments or files.\n";
}

}  // namespace crane::cli
