/// A process of a running stack restarts with another rig file; other programs forge the status of a process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>

#include "../recording/temporary_directory.hpp"
#include "crane/runtime/node.hpp"
#include "crane/security/keys.hpp"
#include "running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 57;
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
    running_.listen(1500ms);  // waits until the causes of the restart itself are inactive
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

/// The running processes keep the rig file that they have read. A process that restarts reads the new one.
TEST(ZoneEditedDuringAMove, ChangesNothingUntilAProcessRestartsAndThenRefusesTheReset) {
  const recording::TemporaryDirectory directory;
  const auto rig = directory / "edited.toml";
  const std::string text = "extends = \"" + stack::find_rig(kOtherRig).string() + "\"\nname = \"edited\"\n";
  recording::put_contents(rig, text);
  RunningStack running{kDomain, rig.string()};
  running.session().arm();
  running.session().request(
      {.kind = crane_REQUEST_MOVE, .selected = {true, false, false}, .target = {0.95, 0, 0}}, "move");
  ASSERT_TRUE(running.until(
      [&] { return std::abs(running.observer().states().back().trolley_speed_mps) > 0.1; }, 5s));
  running.forget();
  // The file becomes invalid first, as while an editor writes it, then has another limit.
  recording::put_contents(rig, text.substr(0, text.size() / 2));
  running.listen(200ms);
  recording::put_contents(rig, text + "[clearance]\nload_radius_m = 0.06\n");
  EXPECT_NO_THROW(running.session().wait_for(crane_STATE_HOLD, 10s));
  EXPECT_NEAR(running.observer().states().back().trolley_position_m, 0.95, 0.05);
  for (const auto& status : running.observer().statuses())
    ASSERT_THAT(status.state, testing::AnyOf(crane_STATE_RUN, crane_STATE_HOLD));
  running.send("trajectory_planner", SIGKILL);
  running.start_again("trajectory_planner");
  ASSERT_TRUE(
      running.until([&] { return running.observer().statuses().back().state == crane_STATE_LOCKED; }, 10s));
  running.listen(3s);
  std::string refusal;
  try {
    running.session().request({.kind = crane_REQUEST_RESET}, "reset");
  } catch (const experiments::SessionError& error) {
    refusal = error.what();
  }
  EXPECT_THAT(refusal, HasSubstr("rig file"));
}

/// Every process may write crane/node, also with keys, and any of them may state the name of another one.
class ForgedStatuses {
 public:
  ForgedStatuses(RunningStack& stack, const runtime::BusOptions& options)
      : stack_{stack}, bus_{runtime::bus_options(options, "forger", crane_SOURCE_RECORDER, 0)} {}
  [[nodiscard]] bool connected() const { return statuses_.matched() > 0; }
  /// For a second, in the names of all processes that have a controller. @param controller  empty: their own
  void send(const char* controller) {
    for (int round = 0; round < 20; ++round) {
      for (auto [name, status] : stack_.observer().nodes()) {
        if (*controller != '\0') runtime::assign(status.controller, controller);
        status.phase = round % 2 == 0 ? crane_PHASE_READY : crane_PHASE_STOPPING;
        EXPECT_TRUE(statuses_.publish(status));
      }
      stack_.listen(50ms);
    }
  }

 private:
  RunningStack& stack_;
  bus::Bus bus_;
  bus::Publisher<msg::NodeStatus> statuses_ = bus_.publisher(topics::node);
};

TEST_F(OtherConfiguration, InAForgedStatusLeavesAnArmedCraneInHold) {
  running_.session().arm();
  ForgedStatuses forged{running_, running_.bus_options()};
  ASSERT_TRUE(running_.until([&] { return forged.connected(); }, 5s));
  running_.forget();
  forged.send("none");
  const auto& statuses = running_.observer().statuses();
  ASSERT_GT(statuses.size(), 50U);
  EXPECT_TRUE(
      std::ranges::all_of(statuses, [](const auto& status) { return status.state == crane_STATE_HOLD; }));
}

TEST_F(OtherConfiguration, IsNotHiddenByAForgedStatus) {
  restart("trajectory_planner", kOtherRig);
  ForgedStatuses forged{running_, running_.bus_options()};
  ASSERT_TRUE(running_.until([&] { return forged.connected(); }, 5s));
  forged.send("");
  EXPECT_THAT(refusal(), HasSubstr("rig file"));
}

/// The same, with keys: the forger has the identity of the recorder; a monitor cannot write at all.
TEST(OtherConfigurationWithKeys, InAForgedStatusLeavesAnArmedCraneInHold) {
  const recording::TemporaryDirectory directory;
  security::make(directory / "keys", security::valid_for(1));
  RunningStack running{kDomain, kRig, stack::Plant::simulated, (directory / "keys").string()};
  running.session().arm();
  auto options = running.bus_options();
  options.vendor = "fastdds";  // Cyclone DDS has only one identity per process: here that of the operator
  ForgedStatuses forged{running, options};
  ASSERT_TRUE(running.until([&] { return forged.connected(); }, 5s));
  running.forget();
  forged.send("none");
  ASSERT_GT(running.observer().statuses().size(), 50U);
  EXPECT_EQ(running.observer().statuses().back().state, crane_STATE_HOLD);
  bus::Bus monitor{runtime::bus_options(options, "monitor", crane_SOURCE_MONITOR, 0)};
  EXPECT_THROW((void)monitor.publisher(topics::node), bus::Error);
}

}  // namespace
}  // namespace crane::system_test
