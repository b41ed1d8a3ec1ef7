/// Completion and manual page are generated from the commands of --help.
#include "cli/command_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../recording/temporary_directory.hpp"
#include "../system/program_run.hpp"
#include "stack/child_processes.hpp"

namespace crane::cli {
namespace {

using system_test::run_program;
using testing::HasSubstr;
using testing::Not;

std::string printed(const std::vector<std::string>& arguments) {
  const auto ended = run_program(stack::program_directory() / "crane", arguments);
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  return ended.output;
}

/// Completions that a shell offers after `words`; the last word is incomplete.
std::string completed_by_bash(const std::string& words, int last) {
  const recording::TemporaryDirectory directory;
  recording::put_contents(directory / "crane", printed({"completion", "bash"}));
  const auto ended =
      run_program("/bin/bash",
                  {"-c", "source " + (directory / "crane").string() + "; COMP_WORDS=(" + words +
                             "); COMP_CWORD=" + std::to_string(last) + "; _crane; echo \"${COMPREPLY[@]}\""});
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  return ended.output;
}

TEST(Completion, OfBashKnowsCommandsSubcommandsAndOptions) {
  EXPECT_EQ(completed_by_bash("crane do", 1), "doctor\n");
  EXPECT_EQ(completed_by_bash("crane topic e", 2), "echo\n");
  EXPECT_THAT(completed_by_bash("crane topic echo crane/state --co", 4), HasSubstr("--count"));
  EXPECT_THAT(completed_by_bash("crane --domain 3 up --bl", 4), HasSubstr("--black-box"));
  EXPECT_EQ(completed_by_bash("crane to", 1), "top topic\n");
  EXPECT_EQ(completed_by_bash("crane scope --tr", 2), "--trigger\n");
  EXPECT_EQ(completed_by_bash("crane no_such_", 1), "\n");
}

TEST(Completion, OfZshNamesEveryCommand) {
  const auto script = printed({"completion", "zsh"});
  EXPECT_THAT(script, testing::StartsWith("#compdef crane"));
  EXPECT_THAT(script, HasSubstr("'crane topic' 'ls echo hz delay"));
}

TEST(ManualPage, HasEveryCommandAndNoErrorOfTroff) {
  const recording::TemporaryDirectory directory;
  const auto page = printed({"man"});
  EXPECT_THAT(page, HasSubstr(".SS crane doctor"));
  EXPECT_THAT(page, HasSubstr("\\-\\-net"));
  for (const char* command : {".SS crane top\n", ".SS crane scope\n"}) EXPECT_THAT(page, HasSubstr(command));
  recording::put_contents(directory / "crane.1", page);
  const auto formatted =
      run_program("/usr/bin/groff", {"-man", "-Tutf8", "-ww", "-z", (directory / "crane.1").string()});
  EXPECT_EQ(formatted.exit_code, 0);
  EXPECT_EQ(formatted.errors, "");
}

}  // namespace
}  // namespace crane::cli
