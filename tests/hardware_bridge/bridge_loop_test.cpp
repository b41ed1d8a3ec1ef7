// Commands that the loop of the bridge accepts, and reports of the bridge about the relay.
#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "crane/boards/emulated_board.hpp"
#include "crane/bridge/bridge.hpp"
#include "crane/bridge/component.hpp"
#include "crane/emulated_rig/wired_rig.hpp"
#include "crane/runtime/in_process.hpp"

namespace crane::bridge {
namespace {

constexpr std::int64_t kPeriod_ns = 10'000'000;
constexpr std::uint64_t kQuiet_ticks = 50;            // Probation::kQuiet_s at 100 Hz
constexpr std::uint64_t kClosed = kQuiet_ticks + 20;  // the relay has closed by then

msg::Command command_of(std::uint64_t tick, double trolley_v) {
  msg::Command command{};
  command.header.tick = tick;
  command.drive_v[0] = trolley_v;
  command.brake_release[0] = trolley_v != 0;
  command.watchdog_permission = true;
  return command;
}

/// Clock of the computer.
std::int64_t now_ns = 0;

/// A board that simulates a pause of the computer while it latches the inputs.
class PausingBoard final : public EmulatedBoard {
 public:
  using EmulatedBoard::EmulatedBoard;
  void advance_to(std::int64_t time_ns) override {
    EmulatedBoard::advance_to(time_ns);
    now_ns += std::exchange(pause_ns, 0);
  }
  std::int64_t pause_ns = 0;  ///< duration of the next pause
};

class BridgeLoop : public testing::Test {
 protected:
  /// Runs the tick at its time. @return the published sample
  msg::State tick(std::uint64_t number) {
    now_ns = static_cast<std::int64_t>(number) * kPeriod_ns;
    bridge_.poll(now_ns);
    const auto state = states_.take();
    EXPECT_TRUE(state && state->header.tick == number);
    if (state) latched_ns_[number] = state->header.sample_time_ns;
    return state.value_or(msg::State{});
  }
  /// Publishes a command with the latch time of its tick in this run.
  void publish(msg::Command command) {
    command.header.sample_time_ns = latched_ns_[command.header.tick];
    EXPECT_TRUE(commands_.publish(command));
  }
  void publish_as_recorded(const msg::Command& command) { EXPECT_TRUE(commands_.publish(command)); }
  /// Ticks 0 to kClosed - 1 with commands: quiet at first, then with permission.
  void run_with_closed_relay() {
    for (std::uint64_t number = 0; number < kClosed; ++number) {
      tick(number);
      auto command = command_of(number, 0);
      command.watchdog_permission = number >= kQuiet_ticks;
      publish(command);
    }
    ASSERT_FALSE(tick(kClosed).watchdog_dropped);
  }
  void pause(std::int64_t duration_ns) { board_->pause_ns = duration_ns; }
  std::string told() {
    std::string codes;
    while (const auto event = events_.take()) codes += std::string{event->code} + ": " + event->what + '\n';
    return codes;
  }

 private:
  std::map<std::uint64_t, std::int64_t> latched_ns_;
  configuration::Rig rig_ = configuration::load_rig(CRANE_RIGS "/emulated_servo_to_go.toml");
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();
  bus::Bus own_{runtime::memory_options(network_, "bridge", crane_SOURCE_BRIDGE)};
  bus::Bus other_{runtime::memory_options(network_, "supervisor", crane_SOURCE_SUPERVISOR)};
  bus::Publisher<msg::Command> commands_ = other_.publisher(topics::command);
  bus::Subscriber<msg::State> states_ = other_.subscriber(topics::state);
  bus::Subscriber<msg::Event> events_ = other_.subscriber(topics::event);
  runtime::Node node_{own_, {"bridge", ""}};
  runtime::ComponentSpec spec_ = hardware_bridge_spec();
  const control::Controller& none_ = *control::find_controller("none");
  control::Design design_;
  runtime::Ports ports_{own_, spec_, none_, design_, runtime::Clock::realtime};
  PausingBoard* board_ = new PausingBoard{rig_, std::make_unique<emulated_rig::WiredRig>(rig_)};
  Bridge bridge_{
      {ports_, node_, rig_, none_, own_.options(), runtime::Clock::realtime, [] { return now_ns; }},
      std::unique_ptr<Board>{board_}};
};

TEST_F(BridgeLoop, ACommandForAnEarlierBridgeIsIgnored) {
  for (std::uint64_t number = 0; number < 20; ++number) {
    publish(command_of(500, 5));
    const auto state = tick(number);
    ASSERT_EQ(state.latch_reason, crane_LATCH_NONE) << number;
    ASSERT_EQ(state.applied_v[0], 0);
    ASSERT_EQ(state.applied_command_tick, number == 0 ? 0 : number - 1);
    publish(command_of(number, 0));
  }
}

/// DDS Security does not prevent a replay of recorded commands to a bridge that has restarted.
TEST_F(BridgeLoop, ARecordedCommandOfAnEarlierRunIsIgnored) {
  for (std::uint64_t number = 0; number < 3 * kQuiet_ticks; ++number) {
    const auto state = tick(number);
    ASSERT_EQ(state.applied_v[0], 0) << number;
    ASSERT_TRUE(state.brake_closed[0] && state.watchdog_dropped) << number;
    auto recorded = command_of(number, number < kQuiet_ticks ? 0 : 5);
    recorded.watchdog_permission = number >= kQuiet_ticks;
    recorded.header.sample_time_ns = state.header.sample_time_ns - 86'400'000'000'000;
    publish_as_recorded(recorded);
  }
}

TEST_F(BridgeLoop, ANewWriterThatCommandsAtOnceMovesNothingForAnyDuration) {
  for (std::uint64_t number = 0; number < 3 * kQuiet_ticks; ++number) {
    const auto state = tick(number);
    ASSERT_EQ(state.applied_v[0], 0) << number;
    ASSERT_TRUE(state.brake_closed[0] && state.watchdog_dropped) << number;
    publish(command_of(number, 5));
  }
}

TEST_F(BridgeLoop, ASampleHasTheTimeOfItsLatchWhenTheComputerPausesBeforeIt) {
  tick(0);
  pause(5'000'000);
  EXPECT_EQ(tick(1).header.sample_time_ns, kPeriod_ns + 5'000'000);
}

TEST_F(BridgeLoop, ARelayThatDropsAfterALateTickIsReportedWithTheDelay) {
  run_with_closed_relay();
  EXPECT_TRUE(tick(kClosed + 3).watchdog_dropped);
  EXPECT_EQ(told(),
            "relay_dropped: the watchdog relay opened although the watchdog output toggled; the longer of "
            "the last two intervals between toggles was 30 ms\n");
}

TEST_F(BridgeLoop, ARelayThatDropsBecauseTheSupervisorWithdrewItsPermissionIsNoEvent) {
  run_with_closed_relay();
  auto last = command_of(kClosed, 0);
  last.watchdog_permission = false;
  publish(last);
  for (std::uint64_t number = kClosed + 1; number < kClosed + 4; ++number) tick(number);
  EXPECT_TRUE(tick(kClosed + 4).watchdog_dropped);
  EXPECT_EQ(told(), "");
}

}  // namespace
}  // namespace crane::bridge
