/// The program `crane jog` with a running stack: deflections, inching, return to the stop point, and the stop
/// of the crane when the program ends.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>

#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"
#include "terminal_run.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 73;

std::vector<std::string> arguments(const RunningStack& stack, const std::string& for_s) {
  return {"jog",
          "--trolley",
          "0.5",
          "--for",
          for_s,
          "--domain",
          std::to_string(kDomain),
          "--crane",
          stack.bus_options().crane};
}

TEST(JogProgram, DeflectsReleasesAndPrintsTheStop) {
  RunningStack stack{kDomain, "virginia_tech_tower"};
  stack.session().arm();
  const auto ended = run_program(stack::program_directory() / "crane", arguments(stack, "1"));
  EXPECT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_NE(ended.output.find("at rest"), std::string::npos) << ended.output;
}

TEST(JogProgram, KilledWithADeflectedStickLeavesACraneThatStopsInHold) {
  RunningStack stack{kDomain, "virginia_tech_tower"};
  stack.session().arm();
  const ProgramRun jog{stack::program_directory() / "crane", arguments(stack, "50")};
  const auto& observer = stack.observer();
  ASSERT_TRUE(stack.until(
      [&] { return !observer.states().empty() && observer.states().back().trolley_speed_mps > 0.1; }, 15s));
  jog.send(SIGKILL);
  stack.forget();
  ASSERT_TRUE(stack.until(
      [&] { return !observer.statuses().empty() && observer.statuses().back().state == crane_STATE_HOLD; },
      15s));
  EXPECT_EQ(observer.statuses().back().cause, crane_CAUSE_NONE);
  EXPECT_LT(std::abs(observer.states().back().trolley_speed_mps), 0.02);
}

TEST(ModeProgram, ChangesAndShowsTheModeOfALockedCraneAndIsRefusedByAnArmedOne) {
  RunningStack stack{kDomain, "virginia_tech_tower"};
  const auto mode = [&](std::vector<std::string> names) {
    names.insert(names.begin(), "mode");
    names.insert(names.end(), {"--domain", std::to_string(kDomain), "--crane", stack.bus_options().crane});
    return run_program(stack::program_directory() / "crane", names);
  };
  EXPECT_EQ(mode({"manual"}).exit_code, 0);
  const auto shown = mode({});
  EXPECT_NE(shown.output.find("manual"), std::string::npos) << shown.output << shown.errors;
  EXPECT_EQ(mode({"fast"}).exit_code, 2);
  stack.session().arm();
  const auto refused = mode({"automatic"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("disarm first"), std::string::npos) << refused.errors;
}

constexpr auto kUp = "\x1b[A", kRight = "\x1b[C";

class JogKeyboard : public testing::Test {
 protected:
  JogKeyboard() { stack_.session().arm(); }

  [[nodiscard]] TerminalRun keyboard(std::vector<std::string> more) const {
    std::vector<std::string> all{"jog", "--domain", std::to_string(kDomain), "--crane",
                                 stack_.bus_options().crane};
    all.insert(all.end(), more.begin(), more.end());
    return {stack::program_directory() / "crane", all, 120, 24};
  }
  /// Holds the key of the slew axis until the axis moves.
  [[nodiscard]] bool slews(TerminalRun& jog) {
    return stack_.until(
        [&] {
          jog.type(kRight);
          stack_.listen(30ms);
          return std::abs(stack_.observer().states().back().slew_speed_radps) > 0.1;
        },
        10s);
  }
  [[nodiscard]] const msg::State& state() {
    stack_.listen(50ms);
    return stack_.observer().states().back();
  }
  [[nodiscard]] bool until_the_trolley_moves() {
    stack_.forget();
    return stack_.until(
        [&] {
          const auto& states = stack_.observer().states();
          return !states.empty() && std::abs(states.back().trolley_speed_mps) > 0.02;
        },
        10s);
  }
  [[nodiscard]] bool until(crane_SupervisorState wanted) {
    return stack_.until(
        [&] {
          const auto& statuses = stack_.observer().statuses();
          return !statuses.empty() && statuses.back().state == wanted;
        },
        15s);
  }

  RunningStack stack_{kDomain, "virginia_tech_tower"};
};

TEST_F(JogKeyboard, InchesByTheStepOnceForAKeyHeldDown) {
  constexpr double kStatic_m = 0.008;  // static friction can hold the trolley this far from its reference
  auto jog = keyboard({"--inch", "--step", "30mm"});
  ASSERT_TRUE(jog.wait_for("30 mm", 20s)) << jog.output();
  const double before_m = state().trolley_position_m;
  for (int i = 0; i < 30; ++i) {
    jog.type(kUp);
    stack_.listen(30ms);
  }
  ASSERT_TRUE(jog.wait_for("inch: trolley", 20s)) << jog.output();
  stack_.listen(1s);
  EXPECT_NEAR(state().trolley_position_m - before_m, 0.03, kStatic_m);
  jog.type("q");
  EXPECT_EQ(jog.wait(10s), 0);
}

TEST_F(JogKeyboard, ReturnsToTheStopPoint) {
  constexpr double kBand = 0.01;       // m, rad: largest position error of a finished move (planner)
  constexpr double kDelay_rad = 0.03;  // 0.1 s between the key and this test's sample, at 0.3 rad/s
  auto jog = keyboard({});
  ASSERT_TRUE(jog.wait_for("full speed", 20s)) << jog.output();
  ASSERT_TRUE(slews(jog));
  jog.type(" ");
  const auto released = state();
  ASSERT_TRUE(jog.wait_for("from the stop point", 20s)) << jog.output();
  EXPECT_GT(state().slew_angle_rad - released.slew_angle_rad, 0.05) << "the shaped stop takes its distance";
  jog.type("r");
  ASSERT_TRUE(jog.wait_for("return: from the stop point", 30s)) << jog.output();
  EXPECT_NEAR(state().slew_angle_rad, released.slew_angle_rad, kBand + kDelay_rad);
  EXPECT_NEAR(state().trolley_position_m, released.trolley_position_m, kBand);
  jog.type("q");
  EXPECT_EQ(jog.wait(10s), 0);
}

TEST_F(JogKeyboard, ForgetsTheStopPointAfterAMotionOfAnotherClient) {
  auto jog = keyboard({});
  ASSERT_TRUE(jog.wait_for("full speed", 20s)) << jog.output();
  ASSERT_TRUE(slews(jog));
  jog.type(" ");
  ASSERT_TRUE(jog.wait_for("from the stop point", 20s)) << jog.output();
  stack_.session().move_to({true, false, false}, {0.6, 0, 0}, 30s);
  jog.type("r");
  EXPECT_TRUE(jog.wait_for("return: there is no stop point", 20s)) << jog.output();
  jog.type("q");
  EXPECT_EQ(jog.wait(10s), 0);
}

TEST_F(JogKeyboard, RefusesAStepBeyondTheLimitsLikeAMove) {
  auto jog = keyboard({"--inch", "--step", "50mm"});
  ASSERT_TRUE(jog.wait_for("50 mm", 20s)) << jog.output();
  const auto near_limit_m = 1.45 - 0.14 - 0.01;  // high_limit and soft_margin of the rig file
  stack_.session().move_to({true, false, false}, {near_limit_m, 0, 0}, 30s);
  jog.type(kUp);
  EXPECT_TRUE(jog.wait_for("inch: refused: trolley target", 20s)) << jog.output();
  EXPECT_TRUE(until(crane_STATE_HOLD));
  jog.type("q");
  EXPECT_EQ(jog.wait(10s), 0);
}

TEST_F(JogKeyboard, StopsTheCraneWhenTheOperatorEndsAStep) {
  auto jog = keyboard({"--inch", "--step", "50mm"});
  ASSERT_TRUE(jog.wait_for("50 mm", 20s)) << jog.output();
  jog.type(kUp);
  ASSERT_TRUE(until_the_trolley_moves());
  jog.type(" ");
  EXPECT_TRUE(jog.wait_for("stopped by the operator", 10s)) << jog.output();
  EXPECT_EQ(jog.wait(10s), 1);
  EXPECT_TRUE(until(crane_STATE_LOCKED));
}

/// Ctrl-S would pause the terminal: the next message would block the program, and the program would read no
/// key.
TEST_F(JogKeyboard, StopsTheCraneDuringAStepAlsoAfterCtrlS) {
  constexpr auto kCtrlS = "\x13";
  auto jog = keyboard({"--inch", "--step", "50mm"});
  ASSERT_TRUE(jog.wait_for("50 mm", 20s)) << jog.output();
  jog.type(kUp);
  ASSERT_TRUE(until_the_trolley_moves());
  jog.type(kCtrlS);
  jog.type("i");  // prints the mode
  jog.type(" ");
  EXPECT_TRUE(until(crane_STATE_LOCKED));
  EXPECT_EQ(jog.wait(10s), 1);
}

/// Nobody reads the pipe that receives the output.
TEST_F(JogKeyboard, StopsTheCraneDuringAStepAlsoWhenItsOutputIsBlocked) {
  const auto pipe = std::filesystem::path{testing::TempDir()} / ("jog_output_" + std::to_string(::getpid()));
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int end = ::open(pipe.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(end, 0);
  TerminalRun jog{"/bin/sh",
                  {"-c", "exec \"$0\" jog --inch --step 50mm --domain \"$1\" --crane \"$2\" > \"$3\"",
                   (stack::program_directory() / "crane").string(), std::to_string(kDomain),
                   stack_.bus_options().crane, pipe.string()},
                  120,
                  24};
  pollfd mode{end, POLLIN, 0};
  ASSERT_EQ(::poll(&mode, 1, 20'000), 1) << "no output";
  stack_.listen(1s);
  while (::write(end, "x", 1) == 1) {
  }
  jog.type(kUp);
  EXPECT_TRUE(until_the_trolley_moves());
  jog.type("i");  // reports the mode
  jog.type(" ");
  EXPECT_TRUE(until(crane_STATE_LOCKED));
  EXPECT_EQ(jog.wait(10s), 1);
  ::close(end);
  std::filesystem::remove(pipe);
}

TEST_F(JogKeyboard, StopsTheCraneWhenTheTerminalClosesDuringAStep) {
  auto jog = keyboard({"--inch", "--step", "50mm"});
  ASSERT_TRUE(jog.wait_for("50 mm", 20s)) << jog.output();
  jog.type(kUp);
  ASSERT_TRUE(until_the_trolley_moves());
  jog.send(SIGHUP);
  EXPECT_EQ(jog.wait(10s), 1);
  EXPECT_TRUE(until(crane_STATE_LOCKED));
}

}  // namespace
}  // namespace crane::system_test
