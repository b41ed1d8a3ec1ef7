#pragma once
/// Compares the rig files and the controllers of the processes of the loop, from crane/node. Limits,
/// calibration and zones of a process that was started with another file contradict those that the supervisor
/// checks.
#include <array>
#include <optional>
#include <string>

#include "crane/runtime/component.hpp"
#include "crane/runtime/node.hpp"

namespace crane::supervisor {

class SameConfiguration {
 public:
  explicit SameConfiguration(const runtime::Context& context)
      : statuses_{context.ports.input(topics::node)}, node_{context.node} {}

  /// Takes a bounded number of samples: a flood must not delay the step. An event names the process when a
  /// difference begins.
  void receive();
  /// True while the newest statuses contradict each other. The status of a process counts until the process
  /// stops or another process takes its place.
  [[nodiscard]] bool differs() const { return !difference_.empty(); }

 private:
  void note(const msg::NodeStatus& status);
  [[nodiscard]] std::string difference() const;

  /// One place per process of the loop: clock master, planner, tracking, anti-swing, friction compensation.
  static constexpr std::size_t kPlaces = 5;
  bus::Subscriber<msg::NodeStatus> statuses_;
  runtime::Node& node_;
  std::array<std::optional<msg::NodeStatus>, kPlaces> newest_;
  std::string difference_;  ///< in words; empty: none
};

}  // namespace crane::supervisor
