/// `crane top` and `crane scope` beside the processes of a running crane, on both vendors, in pipes and on a
/// terminal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "../recording/temporary_directory.hpp"
#include "crane/fields/angle.hpp"
#include "crane/recording/csv.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "terminal_run.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::AllOf, testing::HasSubstr, testing::Not;

constexpr std::uint32_t kDomain = 75;
constexpr double kTrigger_deg = 2;
const auto kCrane = stack::program_directory() / "crane";

std::vector<std::string> on_this_crane(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--domain", std::to_string(kDomain), "--crane", crane_name()});
  return arguments;
}

class Views : public testing::Test {
 protected:
  RunningStack running_{kDomain, "virginia_tech_tower"};
};

TEST_F(Views, TopPrintsOneObjectWithEveryProcessAndTopic) {
  running_.session().arm();
  const auto ended = run_program(kCrane, on_this_crane({"top", "--once", "--json"}));
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  const auto found = nlohmann::json::parse(ended.output);
  EXPECT_EQ(found["supervisor"]["state"], "HOLD");
  EXPECT_EQ(found["supervisor"]["cause"], "NONE");
  ASSERT_EQ(found["processes"].size(), running_.observer().nodes().size());
  for (const auto& process : found["processes"]) {
    const auto& own = running_.observer().nodes().at(process["name"].get<std::string>());
    EXPECT_EQ(process["pid"], own.pid);
    EXPECT_EQ(process["vendor"], own.vendor);
    EXPECT_NEAR(process["tick_rate_hz"].get<double>(), 100, 10) << process["name"];
  }
  const auto& state = found["topics"][0];
  EXPECT_EQ(state["topic"], "crane/state");
  EXPECT_NEAR(state["rate_hz"].get<double>(), 100, 5);
  EXPECT_GT(state["delay_us"]["p50"].get<double>(), 0);
  EXPECT_LE(state["delay_us"]["p50"].get<double>(), state["delay_us"]["max"].get<double>());
}

TEST_F(Views, TopPrintsOneTableWithoutEscapeSequencesIntoAPipe) {
  const auto ended = run_program(kCrane, on_this_crane({"top", "--once"}));
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  EXPECT_THAT(ended.output,
              AllOf(HasSubstr("supervisor  LOCKED because of START"), HasSubstr("trajectory_planner"),
                    HasSubstr("crane/command"), Not(HasSubstr("\x1b"))));
  ProgramRun pipe{kCrane, on_this_crane({"top"})};
  ASSERT_TRUE(pipe.wait_for("crane/command", 20s)) << pipe.errors();
  pipe.send(SIGINT);
  EXPECT_EQ(pipe.wait(5s), 0);
  EXPECT_THAT(pipe.output(), Not(HasSubstr("\x1b")));
}

TEST_F(Views, TopRefreshesInPlaceAndRestoresTheTerminal) {
  for (const bool by_key : {true, false}) {
    TerminalRun top{kCrane, on_this_crane({"top"}), 80, 24};
    const auto before = top.settings();
    ASSERT_TRUE(top.wait_for("crane/command", 20s)) << top.output();
    EXPECT_EQ(top.settings().c_lflag & static_cast<tcflag_t>(ICANON | ECHO), 0U);
    EXPECT_THAT(top.output(), testing::StartsWith("\x1b[?1049h"));
    top.forget();
    ASSERT_TRUE(top.wait_for("\x1b[H", 5s)) << "no refresh";
    top.resize(40, 6);
    ASSERT_TRUE(top.wait_for("more lines", 5s)) << top.output();
    by_key ? top.type("q") : top.send(SIGINT);
    EXPECT_EQ(top.wait(5s), 0);
    EXPECT_THAT(top.output(), HasSubstr("\x1b[?25h\x1b[?1049l"));
    EXPECT_EQ(top.settings().c_lflag, before.c_lflag);
  }
}

/// Whether the condition of the trigger becomes true at a tick, from samples that this test received.
bool crosses_at(const Observer& observer, std::uint64_t tick) {
  double before_rad = 1, at_rad = 0;
  for (const auto& state : observer.states()) {
    if (state.header.tick + 1 == tick) before_rad = std::abs(state.swing_radial_rad);
    if (state.header.tick == tick) at_rad = std::abs(state.swing_radial_rad);
  }
  const double limit_rad = kTrigger_deg * fields::kRadPerDeg;
  return before_rad <= limit_rad && at_rad > limit_rad;
}

std::uint64_t tick_in(const std::string& text) {
  const std::string begin = "trigger at tick ";
  const auto at = text.find(begin);
  return at == std::string::npos ? 0 : std::stoull(text.substr(at + begin.size()));
}

TEST_F(Views, ScopeFindsTheSameTickLiveAndInTheRecording) {
  const recording::TemporaryDirectory directory;
  const auto file = directory / "run.mcap", csv = directory / "capture.csv";
  const std::vector<std::string> trigger{
      "--trigger", "abs(state.swing_radial_rad) > 2deg", "--pre", "200ms", "--post", "500ms",
      "--signal",  "reference.axis[0].position"};
  running_.session().arm();
  ProgramRun record{kCrane, on_this_crane({"record", file.string()})};
  ASSERT_TRUE(running_.until(
      [&] { return std::filesystem::exists(file) && std::filesystem::file_size(file) > 20'000; }, 20s))
      << record.errors();

  auto arguments = on_this_crane({"scope", "--single", "--out", csv.string()});
  arguments.insert(arguments.end(), trigger.begin(), trigger.end());
  ProgramRun scope{kCrane, arguments};
  ASSERT_TRUE(scope.wait_for_error("armed at tick ", 20s)) << scope.errors();
  running_.forget();
  running_.session().request(
      {.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {1.0, 0, 0}}, "move");
  ASSERT_TRUE(running_.until([&] { return running_.session().status()->state == crane_STATE_RUN; }, 5s));
  ASSERT_TRUE(running_.until([&] { return running_.session().status()->state == crane_STATE_HOLD; }, 20s));
  ASSERT_EQ(scope.wait(10s), 0) << scope.errors();
  record.send(SIGINT);
  ASSERT_EQ(record.wait(10s), 0) << record.errors();

  const auto tick = tick_in(scope.output());
  EXPECT_TRUE(crosses_at(running_.observer(), tick)) << scope.output();
  EXPECT_THAT(scope.output(), AllOf(HasSubstr("state.swing_radial_rad [deg]"),
                                    HasSubstr("reference.axis[0].position [m]"), Not(HasSubstr("\x1b"))));

  auto from_file = std::vector<std::string>{"scope", "--file", file.string()};
  from_file.insert(from_file.end(), trigger.begin(), trigger.end());
  const auto again = run_program(kCrane, from_file);
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(again.output.substr(0, again.output.find('(')),
            scope.output().substr(0, scope.output().find('(')));

  const auto table = recording::read_csv(csv);
  ASSERT_NE(table.find("state.swing_radial_rad"), nullptr);
  EXPECT_NEAR(table.find("time_s")->front(), -0.2, 0.011);
  EXPECT_NEAR(table.find("time_s")->back(), 0.5, 0.011);
  for (std::size_t i = 0; i < table.rows(); ++i)
    EXPECT_EQ(table.find("time_s")->at(i) == 0, table.find("tick")->at(i) == static_cast<double>(tick));
}

TEST_F(Views, ScopeWithoutATriggerStatesTheRangesOfItsFields) {
  const auto ended = run_program(
      kCrane, on_this_crane({"scope", "--trigger", "state.trolley_position_m > 100m", "--timeout", "2"}));
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("the trigger did not occur in "),
                                  HasSubstr("state.trolley_position_m was between 0.")));
}

TEST_F(Views, ScopeInPlaceEndsWithTheKeyAndRestoresTheTerminal) {
  TerminalRun scope{kCrane,
                    on_this_crane({"scope", "--auto", "--trigger", "state.trolley_position_m > 100m", "--pre",
                                   "100ms", "--post", "200ms"}),
                    100, 30};
  const auto before = scope.settings();
  ASSERT_TRUE(scope.wait_for("no trigger (automatic)", 20s)) << scope.output();
  scope.type("q");
  EXPECT_EQ(scope.wait(5s), 0);
  EXPECT_THAT(scope.output(), HasSubstr("\x1b[?25h\x1b[?1049l"));
  EXPECT_EQ(scope.settings().c_lflag, before.c_lflag);
}

TEST(ViewsOfNoCrane, NameTheSearchedCraneAndEnd) {
  const auto top = run_program(kCrane, on_this_crane({"top", "--once", "--timeout", "1"}));
  EXPECT_EQ(top.exit_code, 1);
  EXPECT_THAT(top.errors, HasSubstr("in domain 75 on 127.0.0.1: either no stack runs"));
  const auto scope =
      run_program(kCrane, on_this_crane({"scope", "--trigger", "state.command_stale", "--timeout", "1"}));
  EXPECT_EQ(scope.exit_code, 1);
  EXPECT_THAT(scope.errors, HasSubstr("in domain 75 on 127.0.0.1: either no stack runs"));
}

TEST(ViewsOfNoCrane, RefuseBadInputWithAllProblems) {
  const auto ended = run_program(
      kCrane, {"scope", "--trigger", "abs(state.swing_radial_ra) > 5deg and state.trolley_position_m > 3 rad",
               "--signal", "state.aplied_v[0]"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_THAT(ended.errors,
              AllOf(HasSubstr("did you mean state.swing_radial_rad?"), HasSubstr("    ^ character 5: "),
                    HasSubstr("both sides of '>' must be the same quantity"),
                    HasSubstr("--signal: unknown field 'state.aplied_v[0]'; did you mean "
                              "state.applied_v[0]?")));
  const auto time = run_program(kCrane, {"scope", "--trigger", "state.command_stale", "--pre", "3m"});
  EXPECT_EQ(time.exit_code, 2);
  EXPECT_THAT(time.errors, HasSubstr("unit 'm' is no unit of time: use s (default), ms, us, ns"));
  const recording::TemporaryDirectory directory;
  recording::put_contents(directory / "no.mcap", "nothing");
  const auto file = run_program(
      kCrane, {"scope", "--trigger", "state.command_stale", "--file", (directory / "no.mcap").string()});
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_THAT(file.errors, HasSubstr("no.mcap"));
}

}  // namespace
}  // namespace crane::system_test
