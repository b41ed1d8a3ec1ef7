#pragma once
/// The components of a simulated crane in one process, in lockstep, with an operator.
#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <string>

#include "anti_swing/anti_swing.hpp"
#include "crane/runtime/in_process.hpp"
#include "crane/runtime/node.hpp"
#include "crane/runtime/process.hpp"
#include "crane/simulator/component.hpp"
#include "crane/supervisor/component.hpp"
#include "crane/supervisor/states.hpp"
#include "friction_compensation/friction_compensation.hpp"
#include "tracking/tracking.hpp"
#include "trajectory_planner/trajectory_planner.hpp"

namespace crane::jog_test {

inline const char* const kClient = "operator";

class OperatedCrane {
 public:
  explicit OperatedCrane(const std::string& controller)
      : OperatedCrane{controller, configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml")} {}
  OperatedCrane(const std::string& controller, const configuration::Rig& rig)
      : rig_{rig},
        controller_{runtime::chosen_controller(controller, rig_)},
        stack_{specs(), rig_, controller_},
        bus_{runtime::memory_options(stack_.network(), kClient, crane_SOURCE_OPERATOR)},
        requests_{bus_.publisher(topics::request)},
        replies_{bus_.subscriber(topics::reply)},
        states_{bus_.subscriber(topics::state, runtime::loop_endpoint(runtime::Clock::lockstep))},
        statuses_{bus_.subscriber(topics::supervisor, runtime::loop_endpoint(runtime::Clock::lockstep))} {
    run(2.5);
    EXPECT_EQ(ask(crane_REQUEST_RESET), "");
    run(1.1);
    EXPECT_EQ(ask(crane_REQUEST_ARM), "");
    run_until_hold(2);
  }

  std::function<void()> every_tick = [] {};

  void run(double seconds) {
    const auto ticks = std::lround(seconds / rig_.period_s);
    for (long k = 0; k < ticks; ++k) tick();
  }
  /// @return seconds until HOLD; `longest_s` when it does not come
  double run_until_hold(double longest_s) {
    double passed_s = 0;
    for (; passed_s < longest_s && status_.state != crane_STATE_HOLD; passed_s += rig_.period_s) tick();
    return passed_s;
  }
  /// @return reason of the refusal; empty when accepted
  std::string ask(msg::Request request) {
    request.id = ++last_id_;
    runtime::assign(request.client, kClient);
    EXPECT_TRUE(requests_.publish(request));
    run(2 * rig_.period_s);
    while (const auto reply = replies_.take())
      if (reply->request_id == last_id_ && reply->header.source == crane_SOURCE_SUPERVISOR)
        return reply->accepted ? "" : reply->reason;
    return "no answer";
  }
  std::string ask(crane_RequestKind kind) {
    msg::Request request{};
    request.kind = kind;
    return ask(request);
  }
  [[nodiscard]] std::uint64_t last_id() const { return last_id_; }
  [[nodiscard]] bus::Bus& bus() { return bus_; }
  /// Another program on the bus of the stack.
  [[nodiscard]] bus::Bus stranger() const {
    return bus::Bus{runtime::memory_options(stack_.network(), "stranger", crane_SOURCE_OPERATOR)};
  }
  [[nodiscard]] const msg::State& state() const { return state_; }
  [[nodiscard]] const msg::SupervisorStatus& status() const { return status_; }
  [[nodiscard]] std::string cause() const {
    return supervisor::name_of(static_cast<supervisor::Cause>(status_.cause));
  }

 private:
  static const std::vector<runtime::ComponentSpec>& specs() {
    static const std::vector<runtime::ComponentSpec> all{simulator::simulated_plant_spec(),
                                                         services::trajectory_planner_spec(),
                                                         services::tracking_spec(),
                                                         services::anti_swing_spec(),
                                                         services::friction_compensation_spec(),
                                                         supervisor::supervisor_spec()};
    return all;
  }
  void tick() {
    msg::Request advance{};
    advance.id = ++last_advance_;
    runtime::assign(advance.client, "clock");
    advance.kind = crane_REQUEST_ADVANCE;
    advance.until_tick = ++tick_;
    ASSERT_TRUE(requests_.publish(advance));
    while (state_.header.tick < tick_ || status_.header.tick < tick_) {
      const bool worked = stack_.pump();
      while (const auto state = states_.take()) state_ = *state;
      while (const auto status = statuses_.take()) status_ = *status;
      const bool arrived = state_.header.tick >= tick_ && status_.header.tick >= tick_;
      ASSERT_TRUE(worked || arrived || stack_.pump()) << stack_.waiting_for();
    }
    every_tick();
  }

  configuration::Rig rig_;
  const control::Controller& controller_;
  runtime::InProcessStack stack_;
  bus::Bus bus_;
  bus::Publisher<msg::Request> requests_;
  bus::Subscriber<msg::Reply> replies_;
  bus::Subscriber<msg::State> states_;
  bus::Subscriber<msg::SupervisorStatus> statuses_;
  msg::State state_{};
  msg::SupervisorStatus status_{};
  std::uint64_t tick_ = 0, last_id_ = 0, last_advance_ = 0;
};

}  // namespace crane::jog_test
