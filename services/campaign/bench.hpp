#pragma once
/// A crane, its stack and its operator on the test bench: everything a fault can get at, and the log.
#include <cstddef>
#include <functional>
#include <optional>

#include "campaign/faulty_board.hpp"
#include "campaign/judge/record.hpp"
#include "campaign/setting.hpp"
#include "campaign/virtual_stack.hpp"
#include "stack/operator_client.hpp"

namespace crane::campaign {

/// Changes what a component publishes, before it is sealed. @return true when it did
using Madness = std::function<bool(const topics::Description& topic, void* sample)>;

class Bench {
 public:
  /// The stack has started; nothing has happened yet. @throws configuration::ConfigurationError as the
  /// components
  explicit Bench(Setting setting);

  [[nodiscard]] const Setting& setting() const { return setting_; }
  [[nodiscard]] World& world() { return *world_; }
  [[nodiscard]] VirtualStack& stack() { return *stack_; }
  [[nodiscard]] std::size_t axis() const { return setting_.axis; }
  [[nodiscard]] const Row& now() const { return row_; }
  [[nodiscard]] std::int64_t period_ns() const { return period_ns_; }
  /// When the next tick is due.
  [[nodiscard]] std::int64_t next_tick_ns() const { return next_ns_; }

  void tick();
  void run(double seconds);
  /// @return false when it does not hold by then
  bool run_until(const std::function<bool()>& holds, double longest_s);
  void ask(crane_RequestKind kind);
  void ask(const stack::Wish& wish);
  void ask_for_the_move();
  void ask_without_number();  ///< a move whose id is 0
  /// The same without a tick.
  void send(crane_RequestKind kind);
  /// A new process on the same board.
  void restart_bridge();
  /// What came of the newest request; nothing: no answer yet.
  [[nodiscard]] std::optional<msg::Reply> reply();

  Madness mad;
  /// Takes the place of the perfect wire, for every topic.
  bus::Wire wire;
  std::function<void()> every_tick = [] {};

  /// From power-on to the moment. @return false when the crane has not come there
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
  std::shared_ptr<World> world_;
  std::optional<VirtualStack> stack_;
  std::optional<bus::Bus> bus_;
  std::optional<stack::OperatorClient> operator_;
  std::optional<stack::OperatorClient> numberless_;
  std::int64_t period_ns_, next_ns_;
  std::uint64_t last_request_ = 0;
  std::uint32_t next_epoch_;
  bool reset_sent_ = false, arm_sent_ = false;
  std::vector<std::max_align_t> copy_;
  Row row_;
  std::vector<Row> rows_;
};

}  // namespace crane::campaign
