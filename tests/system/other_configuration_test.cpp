/// A process of a running stack restarts with another rig file; other programs forge the status of a process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "../recording/temporary_directory.hpp"
#include "crane/runtime/node.hpp"
#include "crane/security/keys.hpp"
#include "running_stack.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr std::uint32_t kDomain = 93;
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
