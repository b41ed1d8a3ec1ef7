#pragma once
/// A component is one part of the control loop, for example the tracking law. It has named inputs and
/// outputs, internal state, and one step per tick. Two runners execute a component: a separate process over
/// DDS (process.hpp), or one process that runs all components of a stack, over the memory bus or over DDS
/// (in_process.hpp). A component never blocks or sleeps. For control it reads no clock: time is an argument.
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "crane/bus/bus.hpp"
#include "crane/configuration/rig.hpp"
#include "crane/control/law.hpp"
#include "crane/runtime/ports.hpp"

namespace crane::runtime {

inline constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

class Component {
 public:
  virtual ~Component() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Processes the samples that have arrived. @return true when poll() has processed something; the runner
  /// then calls poll() again before it waits
  virtual bool poll(std::int64_t now_ns) = 0;
  /// Time of the next poll() that is due without a new sample; kNever: only new samples need a poll().
  [[nodiscard]] virtual std::int64_t wake_at_ns() const { return kNever; }
  /// True for a clock master: its runner sleeps until wake_at_ns(), and samples do not wake the runner.
  [[nodiscard]] virtual bool paced() const { return false; }
  /// Names the missing inputs, for the message when a lockstep run makes no progress.
  [[nodiscard]] virtual std::string waiting_for() const = 0;
};

class Node;

/// Arguments of a component's constructor. All referenced objects outlive the component.
struct Context {
  Ports& ports;  ///< creates the endpoints that the ComponentSpec of the component declares
  Node& node;
  const configuration::Rig& rig;
  const control::Controller& controller;
  const bus::Options& bus;  ///< domain and crane (partition) of the component
  Clock clock = Clock::lockstep;
  /// Clock of poll() in a process in real time; null: time does not pass during poll() (lockstep, virtual
  /// time).
  std::int64_t (*monotonic_ns)() = nullptr;
};

}  // namespace crane::runtime
