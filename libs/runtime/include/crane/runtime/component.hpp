#pragma once
/// A component is one room of the control loop: named inputs and outputs, its memory, one step per tick.
/// Two hosts run it unchanged: a process of its own over DDS (process.hpp), or all components of a stack in
/// one process over the memory bus (in_process.hpp). A component never blocks, sleeps or reads a clock; time
/// comes in as an argument.
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
  /// Handles what has arrived. @return true when something was done: call again before waiting
  virtual bool poll(std::int64_t now_ns) = 0;
  /// When poll() is due even if nothing arrives; kNever: only samples matter.
  [[nodiscard]] virtual std::int64_t wake_at_ns() const { return kNever; }
  /// True for a clock master: its host sleeps until wake_at_ns() and is not woken by samples.
  [[nodiscard]] virtual bool paced() const { return false; }
  /// What it is waiting for, for the message when a lockstep run stands still.
  [[nodiscard]] virtual std::string waiting_for() const = 0;
};

class Node;

/// What a component is built from. Everything outlives the component.
struct Context {
  Ports& ports;  ///< its endpoints: those that its ComponentSpec declares
  Node& node;
  const configuration::Rig& rig;
  const control::Controller& controller;
  const bus::Options& bus;  ///< domain and crane it runs in
  Clock clock = Clock::lockstep;
};

}  // namespace crane::runtime
