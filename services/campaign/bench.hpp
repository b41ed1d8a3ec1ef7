#pragma once
/// Test bench for fault injection: a simulated crane, its stack, its operator and the log of every tick.
#include <cstddef>
#include <functional>
#include <optional>

#include "campaign/faulty_board.hpp"
#include "campaign/judge/record.hpp"
#include "campaign/setting.hpp"
#include "campaign/virtual_stack.hpp"
#include "stack/operator_client.hpp"

namespace crane::campaign {

/// Changes a published sample before it gets its CRC. @return true when it changed the sample
using PublishFault = std::function<bool(const topics::Description& topic, void* sample)>;

class Bench {
 public:
  /// Starts the stack. @throws configuration::ConfigurationError when a component refuses the rig file
  explicit Bench(Setting setting);

  [[nodiscard]] const Setting& setting() const { return setting_; }
  [[nodiscard]] FaultyRig& rig() { return *rig_; }
  [[nodiscard]] VirtualStack& stack() { return *stack_; }
  [[nodiscard]] std::size_t axis() const { return setting_.axis; }
  [[nodiscard]] const Row& now() const { return row_; }
  [[nodiscard]] std::int64_t period_ns() const { return period_ns_; }
  /// Time of the next tick.
  [[nodiscard]] std::int64_t next_tick_ns() const { return next_ns_; }

  void tick();
  void run(double seconds);
  /// Runs until `holds()` is true. @return false when it is not true within `longest_s`
  bool run_until(const std::function<bool()>& holds, double longest_s);
  void request(crane_RequestKind kind);
  void request(stack::OperatorRequest wanted);
  void request_move();
  void request_without_id();  ///< a move whose id is 0
  /// Sends a request without running a tick.
  void send(crane_RequestKind kind);
  /// Starts a new bridge on the same board.
  void restart_bridge();
  /// Reply to the newest request; nothing: no reply yet.
  [[nodiscard]] std::optional<msg::Reply> reply();

  PublishFault publish_fault;
  /// Transport of all samples; empty: delivers each sample once.
  bus::Wire wire;
  std::function<void()> every_tick = [] {};

  /// Runs from power-on to the given moment. @return false when the crane does not reach the moment
  bool prepare(Moment moment);
  [[nodiscard]] std::vector<Row> take_rows() { return std::move(rows_); }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

 private:
  void note(crane_RequestKind kind);
  void carry(const topics::Description& topic, const void* sample, const bus::Deliver& deliver);
  void tap(const topics::Description& topic, const void* sample);
  [[nodiscard]] double speed_of_axis() const;
  bool reach_hold();
  bool reach_cruise();

  static inline Bench* building_ = nullptr;
  Setting setting_;
  std::shared_ptr<FaultyRig> rig_;
  std::optional<VirtualStack> stack_;
  std::optional<bus::Bus> bus_;
  std::optional<stack::OperatorClient> operator_;
  std::optional<stack::OperatorClient> without_id_;
  std::int64_t period_ns_, next_ns_;
  std::uint64_t last_request_ = 0;
  std::uint32_t next_epoch_;
  bool reset_sent_ = false, arm_sent_ = false;
  std::vector<std::max_align_t> copy_;
  Row row_;
  std::vector<Row> rows_;
};

}  // namespace crane::campaign
