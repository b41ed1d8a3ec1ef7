#pragma once
/// Present state of a running crane.
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "crane/bus/bus.hpp"

namespace crane::cli {

struct Snapshot {
  std::map<std::uint32_t, msg::NodeStatus> nodes;  ///< by node number (Source)
  std::optional<msg::SupervisorStatus> supervisor;
  std::optional<msg::State> state;
  std::optional<msg::Twin> twin;              ///< nothing: no twin runs
  std::optional<msg::Adaptation> adaptation;  ///< nothing: the rig file adapts no axis
  std::vector<bus::OtherVersion> other_versions;
  [[nodiscard]] bool empty() const { return nodes.empty() && !supervisor && !state; }
};

/// Processes of the loop that are missing from the snapshot: "plant or hardware_bridge", "tracking", ...
[[nodiscard]] std::vector<std::string> silent_processes(const Snapshot& snapshot);

/// Listens until three conditions are true, at most for `timeout_s`: every process of the loop has reported;
/// no further process has been discovered for 0.3 s, with keys 1.5 s; crane/state and crane/supervisor have
/// arrived, and crane/twin and crane/adaptation if they have a writer. Packet loss can delay the discovery of
/// a process by seconds.
[[nodiscard]] Snapshot listen(bus::Bus& bus, double timeout_s);
/// Listens to supervisor and state only, until 0.3 s after the first sample of both, at most for `timeout_s`.
/// @return the newest samples
[[nodiscard]] Snapshot safety_state(bus::Bus& bus, double timeout_s);

/// {"nodes": [...], "unheard": [...], "supervisor": {..., "remedy": ...} or null, "state": {...} or null,
/// "twin", "adaptation": likewise, "other_versions": [{"participant", "version"}]}
[[nodiscard]] nlohmann::ordered_json to_json(const Snapshot& snapshot);
/// Prints the processes, the state of the supervisor with cause and remedy, and the axes.
void print(std::ostream& out, const Snapshot& snapshot);
/// Prints the state of the supervisor with cause and remedy.
void print_supervisor(std::ostream& out, const msg::SupervisorStatus& status);
/// "mode        manual: an operator drives with the stick"
void print_mode(std::ostream& out, const msg::SupervisorStatus& status);
/// Prints the latched reason of the bridge, if any.
void print_latch(std::ostream& out, const msg::State& state);
/// Remedy for the cause; empty without a cause.
[[nodiscard]] const char* remedy(const msg::SupervisorStatus& status);

}  // namespace crane::cli
