#pragma once
/// Compares the rig files and the controllers of the processes of the loop, from crane/node. A process with
/// another rig file works with other limits, calibration and zones than those that the supervisor checks.
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

  /// Takes a bounded number of samples, so that a flood does not delay the step. Reports one event, with the
  /// name of the process, when a difference begins.
  void receive();
  /// True while the newest statuses differ in rig file or controller. A status counts until its process
  /// reports PHASE_STOPPING, or until another process reports from the same place.
  [[nodiscard]] bool differs() const { return !difference_.empty(); }

 private:
  void note(const msg::NodeStatus& status);
  [[nodiscard]] std::string difference() const;

  /// One place per process of the loop: clock master, planner, tracking, anti-swing, friction compensation.
  static constexpr std::size_t kPlaces = 5;
  bus::Subscriber<msg::NodeStatus> statuses_;
  runtime::Node& node_;
  std::array<std::optional<msg::NodeStatus>, kPlaces> newest_;
  std::string difference_;  ///< description of the difference; empty: none
};

}  // namespace crane::supervisor
