#include "crane/runtime/command_line.hpp"

#include <CLI/CLI.hpp>
#include <iostream>
#include <sstream>
#include <string>

#include "crane/fields/printable.hpp"
#include "crane/runtime/process.hpp"

namespace crane::runtime {

void refuse_values_of_flags(CLI::App& app) { app.option_defaults()->disable_flag_override(); }

int exit_code_of(const CLI::App& app, const CLI::ParseError& error) {
  std::stringstream problem;
  const int code = app.exit(error, std::cout, problem);
  for (std::string line; std::getline(problem, line);) std::cerr << fields::printable(line) << '\n';
  return code == 0 ? kExitDone : kExitBadInput;
}

}  // namespace crane::runtime
