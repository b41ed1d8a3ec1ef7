/// The command line of every program.
#include "crane/runtime/command_line.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "crane/runtime/process.hpp"

namespace crane::runtime {
namespace {

/// Exit code and standard error of a program with the flag --insecure that is called with this argument.
std::pair<int, std::string> called_with(const std::string& argument) {
  CLI::App app;
  refuse_values_of_flags(app);
  bool insecure = false;
  app.add_flag("--insecure", insecure);
  int exit_code = kExitDone;
  testing::internal::CaptureStderr();
  try {
    app.parse(argument);
  } catch (const CLI::ParseError& error) {
    exit_code = exit_code_of(app, error);
  }
  return {exit_code, testing::internal::GetCapturedStderr()};
}

TEST(CommandLine, AcceptsAFlagWithoutAValue) { EXPECT_EQ(called_with("--insecure").first, kExitDone); }

TEST(CommandLine, RefusesAFlagWithAValue) {
  for (const char* value : {"-1", "false", "0", "yes"}) {
    const auto [exit_code, problem] = called_with(std::string{"--insecure="} + value);
    EXPECT_EQ(exit_code, kExitBadInput) << value;
    EXPECT_NE(problem.find("insecure"), std::string::npos) << problem;
  }
}

TEST(CommandLine, PrintsNoControlCharacterOfAnArgument) {
  const auto [exit_code, problem] = called_with("--\x1b[31mred");
  EXPECT_EQ(exit_code, kExitBadInput);
  EXPECT_EQ(problem.find('\x1b'), std::string::npos);
  EXPECT_NE(problem.find("?[31mred"), std::string::npos) << problem;
}

}  // namespace
}  // namespace crane::runtime
