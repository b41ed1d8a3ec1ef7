#pragma once
/// Reports of a process: its health on crane/node, its events on crane/event and on the console (spdlog).
#include <cstdint>
#include <string>
#include <string_view>

#include "crane/bus/bus.hpp"
#include "crane/fields/printable.hpp"
#include "crane/runtime/ports.hpp"
#include "crane/runtime/tick_join.hpp"

namespace crane::runtime {

struct NodeIdentity {
  std::string name;                 ///< "tracking"
  std::string controller;           ///< name of the controller; empty: the process runs no controller
  std::uint32_t configuration = 0;  ///< configuration::digest(); 0: the process reads no rig file
};

class Node {
 public:
  /// @param bus  outlives the node
  Node(bus::Bus& bus, NodeIdentity identity);

  /// Reports one event on the console and on crane/event. @param code  lower_snake name, stable for scripts
  void info(std::string_view code, std::string_view what);
  void warning(std::string_view code, std::string_view what, std::string_view remedy);
  void error(std::string_view code, std::string_view what, std::string_view remedy);

  /// Records the tick and the execution time of one step.
  void stepped(std::uint64_t tick, std::int64_t sample_time_ns, std::int64_t step_ns);
  /// Publishes the status once a second and on every change of phase. Reports an event when `ports` begins to
  /// drop samples: samples of a second writer, samples with another version of the messages, samples with a
  /// wrong CRC, or samples that could not be sent.
  void beat(std::int64_t now_ns, const Ports& ports, const JoinCounts& counts);
  /// Publishes the status of a process without ports (recorder). @param rejected  samples with a wrong CRC
  void beat(std::int64_t now_ns, crane_NodePhase phase, const JoinCounts& counts, std::uint64_t rejected);
  /// Publishes the last status with PHASE_STOPPING.
  void stopping();

  [[nodiscard]] const NodeIdentity& identity() const { return identity_; }

 private:
  void report_drops(std::int64_t now_ns, const Ports& ports);
  void report_other_versions();
  void publish_event(crane_Severity severity, std::string_view code, std::string_view what,
                     std::string_view remedy);

  bus::Bus* bus_;
  NodeIdentity identity_;
  bus::Publisher<msg::NodeStatus> status_;
  bus::Publisher<msg::Event> events_;
  msg::NodeStatus report_{};
  std::int64_t next_beat_ns_ = 0;
  std::int64_t step_sum_ns_ = 0, step_max_ns_ = 0;
  std::uint64_t steps_ = 0;
  std::uint64_t events_refused_ = 0, rejected_reported_ = 0, refused_reported_ = 0;
  std::size_t versions_reported_ = 0;
  bool dispute_reported_ = false;
};

/// Copies `text` into a bounded IDL string of N - 1 bytes. A longer text ends with its last whole character.
template <std::size_t N>
void assign(char (&field)[N], std::string_view text) {
  const auto n = text.copy(field, fields::whole_characters(text, N - 1));
  for (std::size_t i = n; i < N; ++i) field[i] = '\0';
}

}  // namespace crane::runtime
