#pragma once
/// A foreign program with the bus of this project that behaves as a supervisor.
#include <algorithm>
#include <chrono>
#include <vector>

#include "../system/running_stack.hpp"

namespace crane::hostile {

/// Commands of a supervisor that arms: permission, relay, brakes, then volts that rise no faster than
/// permitted.
inline void arm_and_push(msg::Command& command, const msg::Header& state, int count) {
  constexpr int kPermission = 3, kRelease = 25, kPush = 30;
  constexpr double kStep_v = 0.2, kMost_v = 3;
  command = {};
  command.header = runtime::answer_to(state);
  command.watchdog_permission = count > kPermission;
  for (std::size_t i = 0; i < 2; ++i) {
    command.brake_release[i] = count > kRelease;
    command.drive_v[i] = std::clamp((count - kPush) * kStep_v, 0.0, kMost_v);
  }
}

/// Commands for every received tick, as a supervisor would send them.
class FalseSupervisor {
 public:
  explicit FalseSupervisor(const runtime::BusOptions& options, std::uint32_t epoch = 7)
      : bus_{runtime::bus_options(options, "stranger", crane_SOURCE_SUPERVISOR, epoch)},
        states_{bus_.subscriber(topics::state)},
        commands_{bus_.publisher(topics::command)} {}
  void speak() {
    bus_.wait(std::chrono::milliseconds{2});
    while (const auto state = states_.take()) {
      arm_and_push(command_, state->header, ++spoken_);
      (void)commands_.publish(command_);
      seen_.push_back(*state);
    }
  }
  [[nodiscard]] const std::vector<msg::State>& seen() const { return seen_; }
  bus::Publisher<msg::Command>& commands() { return commands_; }

 private:
  bus::Bus bus_;
  bus::Subscriber<msg::State> states_;
  bus::Publisher<msg::Command> commands_;
  msg::Command command_{};
  int spoken_ = 0;
  std::vector<msg::State> seen_;
};

}  // namespace crane::hostile
