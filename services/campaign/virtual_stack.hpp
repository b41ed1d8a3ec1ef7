#pragma once
/// Runs the real-time stack in one process and in virtual time. The components wait, lose ticks and stop as
/// in separate processes. No result depends on the computer: runs are reproducible bit for bit.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "crane/runtime/hosted_component.hpp"

namespace crane::campaign {

class VirtualStack {
 public:
  /// `rig` and `controller` must outlive the stack.
  /// @param ledger  of all components; null: none
  VirtualStack(std::span<const runtime::ComponentSpec> specs, const configuration::Rig& rig,
               const control::Controller& controller, std::shared_ptr<bus::Ledger> ledger);

  [[nodiscard]] const std::shared_ptr<bus::MemoryNetwork>& network() const { return network_; }
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }
  /// Polls all components until `time_ns`.
  void run_until(std::int64_t time_ns);
  /// Suspends the component until `time_ns`; kNever: the component hangs.
  void suspend(crane_Source source, std::int64_t time_ns);
  /// Ends the process of a component: destroys component and endpoints.
  void kill(crane_Source source);
  /// Restarts a component with another start-up number.
  void restart(crane_Source source, std::uint32_t epoch);

 private:
  struct Slot {
    runtime::ComponentSpec spec;
    std::unique_ptr<bus::Bus> bus;
    std::unique_ptr<runtime::HostedComponent> hosted;
    std::int64_t suspended_until_ns = 0;
  };
  void settle();
  void start_in(Slot& slot, std::uint32_t epoch);
  [[nodiscard]] std::int64_t next_wake_ns() const;
  Slot& slot_of(crane_Source source);
  bool polled(Slot& slot);

  const configuration::Rig& rig_;
  const control::Controller& controller_;
  std::shared_ptr<bus::Ledger> ledger_;
  std::shared_ptr<bus::MemoryNetwork> network_;
  std::vector<Slot> slots_;
  std::int64_t now_ns_ = 1'000'000'000;
};

}  // namespace crane::campaign
