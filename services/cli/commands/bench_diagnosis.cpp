/// crane bench diagnosis: scores the diagnosis on data with hidden effects. A separate program of the tests
/// generates the data, because the generator must share no code with the diagnosis.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <stdexcept>

#include "cli/commands/bench.hpp"
#include "stack/child_processes.hpp"

namespace crane::cli {
namespace {

int bench_diagnosis(std::vector<std::string> arguments) {
  const std::filesystem::path program = stack::program_directory() / "bench_diagnosis";
  if (!std::filesystem::exists(program))
    throw std::runtime_error(program.string() +
                             ": missing; build it with the tests (deploy/build, CRANE_BUILD_TESTS)");
  arguments.insert(arguments.begin(), program.string());
  std::vector<char*> values;
  for (std::string& argument : arguments) values.push_back(argument.data());
  values.push_back(nullptr);
  ::execv(program.c_str(), values.data());
  throw std::runtime_error(program.string() + ": cannot be started");
}

}  // namespace

void add_bench_diagnosis(CLI::App& bench, Action& chosen) {
  auto* command =
      bench.add_subcommand("diagnosis", "Score crane diagnose on generated data with known, hidden causes");
  command->prefix_command();
  command->set_help_flag();  // the program handles --help and all options
  command->footer("Example: crane bench diagnosis --sets 1200 --results score.jsonl");
  command->callback([command, &chosen] {
    chosen = [arguments = command->remaining()] { return bench_diagnosis(arguments); };
  });
}

}  // namespace crane::cli
