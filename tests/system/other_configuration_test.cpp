/// A process of a running stack restarts with another rig file, or reports another controller.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "crane/runtime/node.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 79;
constexpr const char* kRig = "virginia_tech_tower";
constexpr const char* kOtherRig = "virginia_tech_tower_silo";  // the same crane with no-go zones

class OtherConfiguration : public testing::Test {
 protected:
  /// Kills `component`, starts it with `rig`, and waits until it has completed a tick.
  void restart(const std::string& component, const std::string& rig) {
    running_.send(component, SIGKILL);
    running_.listen(200ms);
    running_.start_again(component, rig);
    ASSERT_TRUE(running_.until(
        [&] {
          const auto node = running_.observer().nodes().find(component);
          return node != running_.observer().nodes().end() && node->second.ticks > 0 &&
                 node->second.pid == static_cast<std::uint32_t>(*running_.children().pid_of(component));
        },
        10s));
    running_.listen(1500ms);  // until the causes of the restart itself are inactive
  }
  /// Requests a reset. @return reason of the refusal; empty when accepted
  std::string refusal() {
    try {
      running_.session().request({.kind = crane_REQUEST_RESET}, "reset");
    } catch (const experiments::SessionError& error) {
      return error.what();
    }
    return "";
  }

  RunningStack running_{kDomain, kRig};
};

TEST_F(OtherConfiguration, OfThePlannerRefusesTheResetUntilThePlannerHasTheSameRigFile) {
  restart("trajectory_planner", kOtherRig);
  EXPECT_THAT(refusal(), HasSubstr("rig file"));
  restart("trajectory_planner", "");
  running_.session().arm();
}

TEST_F(OtherConfiguration, ReportedWhileArmedRemovesPower) {
  running_.session().arm();
  bus::Bus bus{runtime::bus_options(running_.bus_options(), "forger", crane_SOURCE_TRACKING, 0)};
  auto statuses = bus.publisher(topics::node);
  auto status = running_.observer().nodes().at("tracking");
  runtime::assign(status.controller, "none");
  ASSERT_TRUE(running_.until([&] { return statuses.matched() > 0; }, 5s));
  running_.forget();
  ASSERT_TRUE(statuses.publish(status));
  EXPECT_TRUE(running_.until(
      [this] {
        const auto& seen = running_.observer().statuses();
        return !seen.empty() && seen.back().cause == crane_CAUSE_CONFIGURATION_DIFFERS;
      },
      2s));
  EXPECT_FALSE(running_.observer().commands().back().brake_release[0]);
}

}  // namespace
}  // namespace crane::system_test
