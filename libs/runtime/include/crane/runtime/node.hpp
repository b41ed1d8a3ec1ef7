#pragma once
/// What every process tells the others about itself: its health on crane/node, what happened on crane/event
/// (and on the console, through spdlog).
#include <cstdint>
#include <string>
#include <string_view>

#include "crane/bus/bus.hpp"
#include "crane/runtime/ports.hpp"
#include "crane/runtime/tick_join.hpp"

namespace crane::runtime {

struct NodeIdentity {
  std::string name;        ///< "tracking"
  std::string controller;  ///< name of the controller, empty where none applies
};

class Node {
 public:
  Node(bus::Bus& bus, NodeIdentity identity);

  /// One event: console and crane/event. `code` is a stable lower_snake name.
  void info(std::string_view code, std::string_view what);
  void warning(std::string_view code, std::string_view what, std::string_view remedy);
  void error(std::string_view code, std::string_view what, std::string_view remedy);

  /// Time spent in one step, and the tick it belonged to.
  void stepped(std::uint64_t tick, std::int64_t sample_time_ns, std::int64_t step_ns);
  /// Publishes the status when a second has passed or the phase has changed. Reports once what `ports` has
  /// begun to drop: samples of a second writer, samples with a wrong CRC, samples that could not be sent.
  void beat(std::int64_t now_ns, const Ports& ports, const JoinCounts& counts);
  /// The same for a process without a wiring of its own (recorder). @param rejected  samples with a wrong CRC
  void beat(std::int64_t now_ns, crane_NodePhase phase, const JoinCounts& counts, std::uint64_t rejected);
  /// Publishes the last status with PHASE_STOPPING.
  void stopping();

  [[nodiscard]] const NodeIdentity& identity() const { return identity_; }

 private:
  void report_drops(std::int64_t now_ns, const Ports& ports);
  void publish_event(crane_Severity severity, std::string_view code, std::string_view what,
                     std::string_view remedy);

  NodeIdentity identity_;
  bus::Publisher<msg::NodeStatus> status_;
  bus::Publisher<msg::Event> events_;
  msg::NodeStatus report_{};
  std::int64_t next_beat_ns_ = 0;
  std::int64_t step_sum_ns_ = 0, step_max_ns_ = 0;
  std::uint64_t steps_ = 0;
  std::uint64_t events_refused_ = 0, told_rejected_ = 0, told_refused_ = 0;
  bool told_dispute_ = false;
};

/// Copies into a bounded IDL string; cuts what does not fit.
template <std::size_t N>
void assign(char (&field)[N], std::string_view text) {
  const auto n = text.copy(field, N - 1);
  for (std::size_t i = n; i < N; ++i) field[i] = '\0';
}

}  // namespace crane::runtime
