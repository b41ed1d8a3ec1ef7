#pragma once
/// A whole stack in one process, with a board whose sensors a test can change, and an operator.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "crane/boards/emulated_board.hpp"
#include "crane/bridge/bridge.hpp"
#include "crane/emulated_rig/wired_rig.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/simulator/component.hpp"
#include "crane/supervisor/states.hpp"
#include "stack/operator_client.hpp"
#include "stack/stack.hpp"

namespace crane::homing_test {

/// deploy/rigs/homing_servo_to_go.toml: positions unknown at power-on; every axis must be homed.
inline configuration::Rig homing_rig() {
  return configuration::load_rig(CRANE_RIGS "/homing_servo_to_go.toml");
}

inline constexpr std::array<const char*, 2> kBoards{"simulated", "emulated"};

/// Faults between rig and bridge.
using Spoil = std::function<void(bridge::Inputs&, const plant::State& truth)>;

/// A board with its crane.
class SpoiltBoard final : public bridge::Board {
 public:
  SpoiltBoard(const configuration::Rig& told, const configuration::Rig& wired, const std::string& kind,
              Spoil& spoil)
      : spoil_{spoil} {
    if (kind == "emulated") {
      auto rig = std::make_unique<emulated_rig::WiredRig>(wired);
      crane_ = &rig->crane();
      board_ = std::make_unique<bridge::EmulatedBoard>(told, std::move(rig));
    } else {
      auto board = std::make_unique<simulator::SimulatedBoard>(simulator::simulated_rig_of(wired));
      crane_ = board.get();
      board_ = std::move(board);
    }
  }
  [[nodiscard]] std::string_view name() const override { return board_->name(); }
  [[nodiscard]] bridge::Inputs read() override {
    auto inputs = board_->read();
    if (spoil_) spoil_(inputs, crane_->truth());
    return inputs;
  }
  std::array<double, bridge::kDrives> write(const bridge::Outputs& outputs) override {
    return board_->write(outputs);
  }
  void make_safe() noexcept override { board_->make_safe(); }
  [[nodiscard]] bool simulates_time() const override { return true; }
  void advance_to(std::int64_t time_ns) override { board_->advance_to(time_ns); }
  [[nodiscard]] simulator::SimulatedBoard& crane() { return *crane_; }

 private:
  Spoil& spoil_;
  std::unique_ptr<bridge::Board> board_;
  simulator::SimulatedBoard* crane_ = nullptr;
};

class LockstepCrane {
 public:
  explicit LockstepCrane(const std::string& kind, configuration::Rig told = homing_rig(),
                         const configuration::Rig& wired = homing_rig())
      : told_{std::move(told)}, wired_{wired}, kind_{kind} {
    making_ = this;  // ComponentSpec::make is a function pointer without a context
    auto specs = stack::stack_with(stack::Plant::simulated);
    specs.front().make = [](const runtime::Context& context) -> std::unique_ptr<runtime::Component> {
      auto board =
          std::make_unique<SpoiltBoard>(making_->told_, making_->wired_, making_->kind_, making_->spoil);
      making_->crane_ = &board->crane();
      return std::make_unique<bridge::Bridge>(context, std::move(board));
    };
    stack_.emplace(specs, told_, runtime::chosen_controller("", told_));
    bus_.emplace(runtime::memory_options(stack_->network(), "operator", crane_SOURCE_OPERATOR));
    operator_.emplace(*bus_, "operator", 1);
    const auto input = runtime::loop_endpoint(runtime::Clock::lockstep);
    states_.emplace(bus_->subscriber(topics::state, input));
    statuses_.emplace(bus_->subscriber(topics::supervisor, input));
    event_samples_.emplace(bus_->subscriber(topics::event));
    run(1.3);
  }

  Spoil spoil;
  std::function<void()> every_tick = [] {};

  void run(double seconds) {
    for (double passed_s = 0; passed_s < seconds - 1e-9; passed_s += told_.period_s) tick();
  }
  /// @return seconds until it holds; `longest_s` when it does not
  double run_until(const std::function<bool()>& holds, double longest_s) {
    double passed_s = 0;
    for (; passed_s < longest_s && !holds(); passed_s += told_.period_s) tick();
    return passed_s;
  }
  /// @return reason of the refusal; empty when accepted
  std::string ask(const stack::OperatorRequest& wanted) { return ask_at_once({wanted}).front(); }
  /// Sends all requests in the same tick.
  std::vector<std::string> ask_at_once(const std::vector<stack::OperatorRequest>& wanted) {
    std::vector<std::uint64_t> ids;
    for (const auto& one : wanted) ids.push_back(operator_->send(one));
    tick();
    tick();
    operator_->receive();
    std::vector<std::string> reasons;
    for (const auto id : ids) reasons.push_back(reason_of(id));
    return reasons;
  }
  std::string reason_of(std::uint64_t id) {
    const auto reply = operator_->take_reply(id, crane_SOURCE_SUPERVISOR);
    if (!reply) return "no answer";
    return reply->accepted ? "" : reply->reason;
  }
  std::string ask(crane_RequestKind kind) { return ask(stack::OperatorRequest{.kind = kind}); }
  std::string home(std::size_t axis) {
    stack::OperatorRequest wanted{.kind = crane_REQUEST_HOME};
    wanted.selected[axis] = true;
    return ask(wanted);
  }
  /// Resets and homes; ends when the brakes are closed again.
  void begin_homing(std::size_t axis) {
    run(1.1);
    ASSERT_EQ(ask(crane_REQUEST_RESET), "");
    run(0.1);
    ASSERT_EQ(home(axis), "");
    run(0.5);
    ASSERT_EQ(status_.state, crane_STATE_RUN) << supervisor::name_of(cause());
  }
  void home_completely(std::size_t axis) {
    begin_homing(axis);
    run_until([this] { return status_.state == crane_STATE_LOCKED; }, 120);
    run(0.3);
    ASSERT_EQ(cause(), supervisor::Cause::homed) << supervisor::name_of(cause()) << " in axis " << axis;
    ASSERT_TRUE(state_.position_known[axis]);
  }
  void arm() {
    run(1.1);
    ASSERT_EQ(ask(crane_REQUEST_RESET), "");
    run(1.1);
    ASSERT_EQ(ask(crane_REQUEST_ARM), "");
    run_until([this] { return status_.state == crane_STATE_HOLD; }, 2);
  }
  [[nodiscard]] supervisor::Cause cause() const { return static_cast<supervisor::Cause>(status_.cause); }
  [[nodiscard]] const msg::State& state() const { return state_; }
  [[nodiscard]] const msg::SupervisorStatus& status() const { return status_; }
  /// Number of events with this code since the start.
  [[nodiscard]] int events(const std::string& code) const {
    const auto found = events_.find(code);
    return found == events_.end() ? 0 : found->second;
  }
  [[nodiscard]] double shown(std::size_t axis) const {
    return std::array{state_.trolley_position_m, state_.slew_angle_rad, state_.cable_length_m}[axis];
  }
  [[nodiscard]] double truth(std::size_t axis) const {
    return plant::position(crane_->truth(), static_cast<plant::Axis>(axis));
  }
  [[nodiscard]] simulator::SimulatedBoard& crane() { return *crane_; }
  /// 0 V, and every brake closed.
  [[nodiscard]] bool safe() const {
    const auto inputs = crane_->read();
    return crane_->converter_v() == std::array<double, bridge::kDrives>{} &&
           inputs.brake_closed == std::array<bool, bridge::kDrives>{true, true, true};
  }

 private:
  void tick() {
    operator_->send({.kind = crane_REQUEST_ADVANCE, .until_tick = ++tick_});
    while (state_.header.tick < tick_ || status_.header.tick < tick_) {
      ASSERT_TRUE(stack_->pump() || take()) << stack_->waiting_for();
      take();
    }
    every_tick();
  }
  bool take() {
    bool any = false;
    while (const auto state = states_->take()) state_ = *state, any = true;
    while (const auto status = statuses_->take()) status_ = *status, any = true;
    while (const auto event = event_samples_->take()) ++events_[event->code];
    return any;
  }

  static inline LockstepCrane* making_ = nullptr;
  configuration::Rig told_, wired_;
  std::string kind_;
  simulator::SimulatedBoard* crane_ = nullptr;
  std::optional<runtime::InProcessStack> stack_;
  std::optional<bus::Bus> bus_;
  std::optional<stack::OperatorClient> operator_;
  std::optional<bus::Subscriber<msg::State>> states_;
  std::optional<bus::Subscriber<msg::SupervisorStatus>> statuses_;
  std::optional<bus::Subscriber<msg::Event>> event_samples_;
  std::map<std::string, int> events_;
  msg::State state_{};
  msg::SupervisorStatus status_{};
  std::uint64_t tick_ = 0;
};

}  // namespace crane::homing_test
