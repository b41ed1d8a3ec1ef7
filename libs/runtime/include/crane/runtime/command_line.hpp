#pragma once
/// Command line of every program, parsed by CLI11.
namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace crane::runtime {

/// Call before options are added. A flag then accepts no value: CLI11 would read `--flag=-1` as a set flag.
void refuse_values_of_flags(CLI::App& app);

/// Prints the requested help or the error, without control characters of an argument.
/// @return exit code of the program
[[nodiscard]] int exit_code_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace crane::runtime
