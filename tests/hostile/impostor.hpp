#pragma once
/// Packets with the GUID of the supervisor's writer.
#include <algorithm>

#include "forged.hpp"
#include "wire.hpp"

namespace crane::hostile {

/// Forges the next packets of the supervisor. A HEARTBEAT makes the reader of the bridge skip the next
/// sequence numbers of the supervisor; the forged packets use the numbers after the skipped ones.
class Impostor {
 public:
  explicit Impostor(Packet model)
      : packet_{std::move(model)}, found_{find(packet_.message, topics::command).value()} {
    constexpr std::uint64_t kAhead = 1'000'000;
    number_ = sequence_number_of(packet_.message, found_.data) + kAhead;
    auto skip = packet_;
    const auto writer = entities_of(packet_.message, found_.data).writer;
    skip.message = heartbeat(prefix_of(packet_.message), writer, number_);
    mouth_.send(skip);
  }
  /// A command for a tick, as a supervisor that arms would send it: permission, brakes, then rising volts.
  void command(std::uint64_t tick) {
    auto command = found_.sample;
    command.header.tick = tick;
    ++ticks_;
    command.watchdog_permission = ticks_ > 10;
    constexpr double kStep_v = 0.2;
    for (std::size_t i = 0; i < 2; ++i) {
      command.brake_release[i] = ticks_ > 40;
      command.drive_v[i] = std::clamp((ticks_ - 40) * kStep_v, 0.0, 3.0);
    }
    replace(packet_.message, found_.data, topics::command, command);
    set_sequence_number(packet_.message, found_.data, number_++);
    mouth_.send(packet_);
  }
  [[nodiscard]] std::uint64_t sent() const { return mouth_.sent(); }

 private:
  Packet packet_;
  Found<msg::Command> found_;
  std::uint64_t number_ = 0;
  int ticks_ = 0;
  Mouth mouth_;
};

}  // namespace crane::hostile
