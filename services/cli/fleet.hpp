#pragma once
/// Several cranes on this computer, each started by `crane up`, for `crane bench fleet`.
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "crane/configuration/rig.hpp"
#include "stack/child_processes.hpp"
#include "stack/launch.hpp"
#include "stack/operator_client.hpp"

namespace crane::cli {

/// Processor time [ns] and memory of `crane up` and all its child processes.
struct CraneUse {
  std::int64_t loop_ns = 0;   ///< processes of the control loop
  std::int64_t other_ns = 0;  ///< crane up, black box
  /// proportional set size: a page that n processes share counts 1/n for each
  double memory_mb = 0;
  int processes = 0;
};
[[nodiscard]] CraneUse use_of(pid_t crane_up);

struct FleetCrane {
  std::string name;
  pid_t pid = 0;  ///< of `crane up`
  std::int64_t started_ns = 0;
  std::optional<double> start_up_s{};  ///< from the start until every process of the loop is ready
  int moves = 0;                       ///< number of accepted moves
  std::map<std::string, msg::NodeStatus> statuses{};  ///< newest status of each component

  /// @return number of lost ticks, since the start, of the component with the most lost ticks
  [[nodiscard]] std::uint64_t lost_ticks() const;
};

/// Observes all cranes with one participant, whose DDS partition PREFIX* matches the partitions of all
/// cranes. Operates each crane with a separate participant.
class Fleet {
 public:
  /// @param bus  `bus.crane` is the common prefix of the names of the cranes
  Fleet(const runtime::BusOptions& bus, const configuration::Rig& rig);

  void add(std::string name, pid_t crane_up);
  /// Receives statuses and replies. After operate(), also sends requests to each crane: the cycle reset, arm,
  /// move until the crane has accepted a move; then only moves.
  void poll();
  /// Permits poll() to send requests.
  void operate() { operates_ = true; }
  [[nodiscard]] const std::vector<FleetCrane>& cranes() const { return cranes_; }

 private:
  /// Operator of one crane.
  struct Operator {
    explicit Operator(const runtime::BusOptions& options);
    bus::Bus bus;
    stack::OperatorClient client;
    bus::Subscriber<msg::SupervisorStatus> supervisor;
    stack::OperatorRequest next{};
    std::vector<std::uint64_t> moves_sent{};
    std::size_t requests = 0;  ///< sent before the first accepted move
    std::int64_t next_ns = 0;
  };

  void take_statuses(std::int64_t now_ns);
  void operate(Operator& by, FleetCrane& crane, std::int64_t now_ns) const;
  FleetCrane* owner_of(pid_t process);

  runtime::BusOptions options_;
  bus::Bus bus_;
  bus::Subscriber<msg::NodeStatus> statuses_;
  std::vector<FleetCrane> cranes_;
  std::deque<Operator> operators_;       ///< in the order of cranes_
  std::map<pid_t, std::size_t> owners_;  ///< index of the crane of a process
  std::size_t axis_ = 0;                 ///< the axis that moves
  std::array<double, 2> targets_{};      ///< targets of alternate moves, m or rad
  bool operates_ = false;
};

}  // namespace crane::cli
