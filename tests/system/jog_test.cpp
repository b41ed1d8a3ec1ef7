/// The operator's program is killed while the stick is deflected: the crane stops by itself.
#include <gtest/gtest.h>

#include <cmath>

#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

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

}  // namespace
}  // namespace crane::system_test
