#pragma once
/// Reads crane/supervisor and crane/node to detect another supervisor of this crane, and reports it.
#include "crane/runtime/component.hpp"
#include "crane/runtime/node.hpp"
#include "process/sole_supervisor.hpp"

namespace crane::supervisor {

class SoleReader {
 public:
  explicit SoleReader(const runtime::Context& context)
      : sole_{context.bus.epoch, context.rig.period_s},
        supervisors_{context.ports.input(topics::supervisor)},
        nodes_{context.ports.input(topics::node)},
        node_{context.node},
        realtime_{context.clock == runtime::Clock::realtime} {}

  /// Takes a bounded number of samples: a flood must not delay the step. The samples have no effect in
  /// lockstep, because there the time does not advance without the plant.
  /// @throws std::runtime_error that names the other supervisor when this process must exit
  void take(std::int64_t now_ns);
  /// Call once for each published status of this process.
  void stepped(State state) { sole_.stepped(static_cast<crane_SupervisorState>(state)); }
  /// @return true while another supervisor runs
  [[nodiscard]] bool disputed(std::int64_t now_ns) const { return sole_.disputed(now_ns); }

 private:
  [[noreturn]] void yield();

  SoleSupervisor sole_;
  bus::Subscriber<msg::SupervisorStatus> supervisors_;
  bus::Subscriber<msg::NodeStatus> nodes_;
  runtime::Node& node_;
  bool realtime_;
  bool reported_ = false;
};

}  // namespace crane::supervisor
