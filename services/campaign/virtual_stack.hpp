#pragma once
/// A whole stack as it runs in real time, in one process and in virtual time: the components have the clock
/// `realtime`, and the time they are given is made here. A component waits, gives up and stops exactly as in
/// a process of its own; nothing depends on the computer, so that two runs are equal bit for bit.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "crane/runtime/hosted_component.hpp"

namespace crane::campaign {

class VirtualStack {
 public:
  /// `rig` and `controller` must outlive the stack.
  VirtualStack(std::span<const runtime::ComponentSpec> specs, const configuration::Rig& rig,
               const control::Controller& controller);

  [[nodiscard]] const std::shared_ptr<bus::MemoryNetwork>& network() const { return network_; }
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
  /// Lets everybody do what is due until `time_ns`.
  void run_until(std::int64_t time_ns);
  /// The component does nothing before `time_ns`; kNever: it hangs.
  void suspend(crane_Source source, std::int64_t time_ns);
  /// The process has ended: its endpoints are gone, its destructors have run.
  void kill(crane_Source source);
  /// A process that is started anew, with another start-up number.
  void restart(crane_Source source, std::uint32_t epoch);

 private:
  struct Room {
    runtime::ComponentSpec spec;
    std::unique_ptr<bus::Bus> bus;
    std::unique_ptr<runtime::HostedComponent> hosted;
    std::int64_t suspended_until_ns = 0;
  };
  void settle();
  void fill(Room& room, std::uint32_t epoch);
  [[nodiscard]] std::int64_t next_wake_ns() const;
  Room& room_of(crane_Source source);
  bool polled(Room& room);

  const configuration::Rig& rig_;
  const control::Controller& controller_;
  std::shared_ptr<bus::MemoryNetwork> network_;
  std::vector<Room> rooms_;
  std::int64_t now_ns_ = 1'000'000'000;
};

}  // namespace crane::campaign
