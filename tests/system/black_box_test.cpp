/// The black box of `crane up` runs without a request and records every stop.
#include <gmock/gmock.h>

#include <thread>

#include "../recording/temporary_directory.hpp"
#include "crane/recording/mcap_reader.hpp"
#include "program_run.hpp"
#include "review/review.hpp"
#include "running_stack.hpp"
#include "stack/child_processes.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 74;

class BlackBox : public testing::Test {
 protected:
  BlackBox() { EXPECT_TRUE(up.wait_for("is up with", 30s)) << up.errors(); }
  static std::vector<std::string> with_bus(std::vector<std::string> command, const std::string& crane) {
    command.insert(command.end(), {"--domain", std::to_string(kDomain), "--crane", crane});
    return command;
  }
  void ask(const std::vector<std::string>& command) {
    const auto ended = run_program(program(), with_bus(command, crane));
    EXPECT_EQ(ended.exit_code, 0) << command.front() << ": " << ended.errors;
  }
  /// Repeats the request while it is refused: during the self-test, or until all inputs have been complete
  /// for a second.
  void ask_until_accepted(const std::string& request) {
    const auto deadline = std::chrono::steady_clock::now() + 10s;
    while (run_program(program(), with_bus({request}, crane)).exit_code != 0)
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << request;
  }
  /// Reset, armed and moving.
  void start_a_move() {
    ask_until_accepted("reset");
    ask_until_accepted("arm");
    ask({"move", "--trolley", "1.0"});
  }
  static std::filesystem::path program() { return stack::program_directory() / "crane"; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator{kept})
      if (entry.path().extension() == ".mcap") found.push_back(entry.path());
    return found;
  }
  void kill_process(const std::string& name) {
    const auto pids = processes_with("crane_" + name);
    for (const auto pid : pids)
      for (const auto ours : processes_with(crane))
        if (pid == ours) ::kill(pid, SIGKILL);
  }

  recording::TemporaryDirectory directory;
  std::filesystem::path kept = directory / "kept";
  std::string crane = crane_name();
  ProgramRun up{program(), with_bus({"up", "--black-box", kept.string()}, crane)};
};

TEST_F(BlackBox, RecordsAStopWithTheRigFileAndTheProcesses) {
  start_a_move();
  ask({"estop"});
  for (const auto deadline = std::chrono::steady_clock::now() + 15s; files().empty();
       std::this_thread::sleep_for(20ms))
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << up.errors();
  ASSERT_EQ(files().size(), 1U);
  const auto found = review::review(files()[0]);
  EXPECT_THAT(review::sentences(found).front(), HasSubstr("The first cause is OPERATOR_ESTOP"));
  const auto at_ns = found.first_stop()->notes.front().at_ns;
  EXPECT_NEAR(static_cast<double>(found.end_ns - at_ns) * 1e-9, 5, 0.1);
  EXPECT_GT(found.curves.time_s.size(), 500U);
  EXPECT_TRUE(found.problems.empty());
  recording::McapReader reader{files()[0]};
  ASSERT_EQ(reader.attachments().size(), 1U);
  EXPECT_EQ(reader.attachments()[0].name, "virginia_tech_tower.toml");
  const auto metadata = reader.metadata();
  ASSERT_EQ(metadata.size(), 3U);
  EXPECT_EQ(metadata[0].entries.at("crane"), crane);
  EXPECT_THAT(metadata[2].entries.at("supervisor"), AllOf(HasSubstr("cyclone"), HasSubstr("start ")));
  EXPECT_EQ(metadata[2].entries.size(), 6U);
}

TEST_F(BlackBox, RecordsTheEndOfAProcessAsTheFirstCauseOfTheEndOfTheStack) {
  start_a_move();
  kill_process("tracking");
  EXPECT_EQ(up.wait(15s), 1) << up.errors();
  ASSERT_EQ(files().size(), 1U) << up.errors();
  EXPECT_THAT(review::sentences(review::review(files()[0])).front(),
              AllOf(HasSubstr("process_ended"), HasSubstr("tracking has ended: signal 9")));
}

TEST_F(BlackBox, RecordsTheEndOfCraneUpThatSomeoneKilled) {
  start_a_move();
  up.send(SIGKILL);
  EXPECT_EQ(up.wait(15s), 128 + SIGKILL);
  for (const auto deadline = std::chrono::steady_clock::now() + 15s; files().empty();
       std::this_thread::sleep_for(20ms))
    ASSERT_LT(std::chrono::steady_clock::now(), deadline);
  ASSERT_EQ(files().size(), 1U);
  EXPECT_THAT(
      review::sentences(review::review(files()[0])).front(),
      AllOf(HasSubstr("The first cause is STACK_KILLED"), HasSubstr("crane up ended before its processes")));
}

TEST_F(BlackBox, RecordsNothingWhenAnOperatorEndsTheStack) {
  start_a_move();
  up.send(SIGINT);
  EXPECT_EQ(up.wait(15s), 0) << up.errors();
  EXPECT_TRUE(files().empty()) << files()[0];
}

TEST_F(BlackBox, EndsWithoutAnEffectOnTheStack) {
  const auto ups = processes_with("--black-box");
  for (const auto pid : processes_with(kept.string()))
    if (std::ranges::find(ups, pid) == ups.end()) ::kill(pid, SIGKILL);
  start_a_move();
  ask({"status"});
  up.send(SIGINT);
  EXPECT_EQ(up.wait(15s), 0) << up.errors();
  EXPECT_THAT(up.errors(), HasSubstr("the crane continues without its black box"));
}

TEST(BlackBoxWithoutADirectory, DoesNotPreventTheStart) {
  const recording::TemporaryDirectory directory;
  const auto program = stack::program_directory() / "crane";
  recording::put_contents(directory / "file", "");
  ProgramRun up{program,
                {"up", "--domain", std::to_string(kDomain), "--crane", crane_name(), "--priority", "0",
                 "--black-box", (directory / "file").string()}};
  ASSERT_TRUE(up.wait_for("Ctrl-C ends it", 30s)) << up.errors();
  EXPECT_THAT(up.output() + up.errors(),
              testing::AnyOf(HasSubstr("stops are not recorded: black_box has ended: exit code 2"),
                             HasSubstr("the crane continues without its black box")));
  EXPECT_THAT(up.errors(), HasSubstr("directory of the black box"));
  EXPECT_EQ(run_program(program, {"status", "--domain", std::to_string(kDomain), "--crane", crane_name()})
                .exit_code,
            0);
  up.send(SIGINT);
  EXPECT_EQ(up.wait(15s), 0) << up.errors();
}

}  // namespace
}  // namespace crane::system_test
