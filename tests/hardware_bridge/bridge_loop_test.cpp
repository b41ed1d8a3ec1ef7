// Which commands the bridge's loop listens to.
#include <gtest/gtest.h>

#include "crane/boards/emulated_board.hpp"
#include "crane/boards/wired_rig.hpp"
#include "crane/bridge/bridge.hpp"
#include "crane/runtime/in_process.hpp"

namespace crane::bridge {
namespace {

msg::Command command_of(std::uint64_t tick, double trolley_v) {
  msg::Command command{};
  command.header.tick = tick;
  command.drive_v[0] = trolley_v;
  command.brake_release[0] = trolley_v != 0;
  command.watchdog_permission = true;
  return command;
}

TEST(BridgeLoop, ACommandThatAnswersABridgeBeforeItIsNotListenedTo) {
  constexpr std::int64_t kPeriod_ns = 10'000'000;
  const auto rig = runtime::load_rig(CRANE_RIGS "/emulated_servo_to_go.toml");
  const auto network = bus::make_memory_network();
  bus::Bus own{runtime::memory_options(network, "bridge", crane_SOURCE_BRIDGE)};
  bus::Bus other{runtime::memory_options(network, "supervisor", crane_SOURCE_SUPERVISOR)};
  auto commands = other.publisher(topics::command);
  auto states = other.subscriber(topics::state);
  runtime::Node node{own, {"bridge", ""}};
  Bridge bridge{{own, node, rig, *control::find_controller("none"), runtime::Clock::realtime},
                std::make_unique<EmulatedBoard>(rig, std::make_unique<WiredRig>(rig))};
  for (std::uint64_t tick = 0; tick < 20; ++tick) {
    auto of_another = command_of(500, 5);
    commands.publish(of_another);
    bridge.poll(static_cast<std::int64_t>(tick) * kPeriod_ns);
    const auto state = states.take();
    ASSERT_TRUE(state && state->header.tick == tick);
    ASSERT_EQ(state->latch_reason, crane_LATCH_NONE) << tick;
    ASSERT_EQ(state->applied_v[0], 0);
    ASSERT_EQ(state->applied_command_tick, tick == 0 ? 0 : tick - 1);
    auto answer = command_of(tick, 0);
    commands.publish(answer);
  }
}

}  // namespace
}  // namespace crane::bridge
