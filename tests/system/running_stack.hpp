#pragma once
/// The processes of a stack in real time, an operator, and a record of all received samples.
#include <csignal>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/realtime_session.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::system_test {

/// A unique name, which separates this test from other cranes in its domain.
[[nodiscard]] std::string crane_name();

/// Received samples in the order of arrival, with the time of their writer [ns since 1970].
class Observer {
 public:
  explicit Observer(bus::Bus& bus);
  void take();

  [[nodiscard]] const std::vector<msg::State>& states() const { return states_; }
  [[nodiscard]] const std::vector<msg::SupervisorStatus>& statuses() const { return statuses_; }
  [[nodiscard]] const std::vector<std::int64_t>& status_times_ns() const { return status_times_ns_; }
  [[nodiscard]] const std::vector<msg::Command>& commands() const { return commands_; }
  [[nodiscard]] const std::vector<std::int64_t>& command_times_ns() const { return command_times_ns_; }
  /// The newest status of every process, by name.
  [[nodiscard]] const std::map<std::string, msg::NodeStatus>& nodes() const { return nodes_; }
  /// Clears all samples that have arrived, those not taken yet included, except the status of the nodes.
  void forget();

 private:
  bus::Subscriber<msg::State> state_input_;
  bus::Subscriber<msg::SupervisorStatus> status_input_;
  bus::Subscriber<msg::Command> command_input_;
  bus::Subscriber<msg::NodeStatus> node_input_;
  std::vector<msg::State> states_;
  std::vector<msg::SupervisorStatus> statuses_;
  std::vector<msg::Command> commands_;
  std::vector<std::int64_t> status_times_ns_, command_times_ns_;
  std::map<std::string, msg::NodeStatus> nodes_;
};

/// Options of a stack of this test, with a ledger.
[[nodiscard]] stack::LaunchOptions launch_options(std::uint32_t domain, const std::string& rig);

class RunningStack {
 public:
  /// Starts a stack and waits until it is ready.
  explicit RunningStack(stack::LaunchOptions options, stack::Plant plant = stack::Plant::simulated);
  /// @param keys    directory of keys; empty: none
  /// @param vendor  DDS vendor of all processes
  /// @param ledger  false: the processes of the loop have no ledger, as when they are started one by one
  RunningStack(std::uint32_t domain, const std::string& rig, stack::Plant plant = stack::Plant::simulated,
               const std::string& keys = "", const std::string& vendor = "cyclone", bool ledger = true);

  [[nodiscard]] experiments::RealtimeSession& session() { return *session_; }
  [[nodiscard]] stack::ChildProcesses& children() { return children_; }
  [[nodiscard]] const Observer& observer() const { return *observer_; }
  [[nodiscard]] const runtime::BusOptions& bus_options() const { return options_.bus; }
  void forget() { observer_->forget(); }

  /// Sends `signal` to a process of the stack.
  void send(const std::string& component, int signal) const;
  /// Restarts a process of the stack. @param rig  name of its rig file; empty: the rig file of the stack
  void start_again(const std::string& component, const std::string& rig = "");
  /// Receives until `condition` holds. @return false when it does not within `patience`
  bool until(const std::function<bool()>& condition, std::chrono::milliseconds patience);
  void listen(std::chrono::milliseconds duration);

 private:
  stack::LaunchOptions options_;
  std::vector<runtime::ComponentSpec> specs_;
  stack::ChildProcesses children_;
  std::optional<bus::Bus> bus_;
  std::optional<Observer> observer_;
  std::optional<experiments::RealtimeSession> session_;
};

/// Time of a clock [ns].
[[nodiscard]] std::int64_t clock_ns(clockid_t clock);

}  // namespace crane::system_test
