#pragma once
/// The process of the supervisor in real time, with a clock that the test sets. Times in milliseconds.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "crane/runtime/in_process.hpp"
#include "crane/supervisor/component.hpp"

namespace crane::supervisor {

class SupervisorInRealTime : public testing::Test {
 protected:
  static constexpr std::int64_t kBegin_ns = 1'000'000'000;

  /// Runs complete ticks in time; the step of tick 10 is at 100.5 ms.
  /// @param bridge_ahead_ns  offset of the clock of the bridge's host relative to that of the supervisor
  /// @param model_checks     Limits::model_checks of the rig file
  /// @param ticks            number of complete ticks
  explicit SupervisorInRealTime(std::int64_t bridge_ahead_ns = 0, bool model_checks = true,
                                std::uint64_t ticks = 10)
      : bridge_ahead_ns_{bridge_ahead_ns}, rig_{tower(model_checks)} {
    state_.configuration = demand_.configuration = reference_.configuration =
        configuration::digest(rig_, rig_.controller);
    for (std::uint64_t tick = 1; tick <= ticks; ++tick) {
      const double at_ms = 10.0 * static_cast<double>(tick);
      state_comes(tick);
      wake_at(at_ms);
      demand_comes(tick);
      wake_at(at_ms + 0.5);
    }
    EXPECT_EQ(missing(), 0U);
  }

  /// @param wrong_time_ns  sample time of the state; 0: the correct one
  void state_comes(std::uint64_t tick, std::int64_t wrong_time_ns = 0) {
    state_.header = header(tick);
    if (wrong_time_ns != 0) state_.header.sample_time_ns = wrong_time_ns;
    EXPECT_TRUE(states_.publish(state_));
  }
  void demand_comes(std::uint64_t tick) {
    demand_.header = header(tick);
    EXPECT_TRUE(demands_.publish(demand_));
    reference_.header = header(tick);
    EXPECT_TRUE(references_.publish(reference_));
  }
  /// Schedules the process now.
  void wake_at(double time_ms) {
    const auto now_ns = kBegin_ns + std::llround(time_ms * 1e6);
    while (supervisor_->poll(now_ns)) continue;
    while (const auto status = statuses_.take()) {
      status_ = *status;
      ++steps_;
    }
  }
  /// Runs until `time_ms`: the process repeatedly sleeps until its wake-up time.
  void sleep_until(double time_ms) {
    for (double next_ms = due_ms(); next_ms <= time_ms; next_ms = due_ms()) wake_at(next_ms);
  }
  [[nodiscard]] double due_ms() const {
    return static_cast<double>(supervisor_->wake_at_ns() - kBegin_ns) * 1e-6;
  }
  [[nodiscard]] std::uint64_t missing() const { return status_.missing_demand_count; }
  [[nodiscard]] bool demand_is_stale() const { return status_.demand_stale; }
  [[nodiscard]] bool state_is_stale() const { return status_.state_stale; }
  [[nodiscard]] int steps() const { return steps_; }
  [[nodiscard]] crane_SupervisorState supervisor_state() const { return status_.state; }
  [[nodiscard]] crane_Cause cause() const { return status_.cause; }

  msg::State state_{};
  msg::Demand demand_{};
  msg::Reference reference_{};
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();

 private:
  [[nodiscard]] static configuration::Rig tower(bool model_checks) {
    auto rig = configuration::load_rig(CRANE_RIGS "/virginia_tech_tower.toml");
    rig.limits.model_checks = model_checks;
    return rig;
  }
  [[nodiscard]] msg::Header header(std::uint64_t tick) const {
    msg::Header header{};
    header.tick = tick;
    header.sample_time_ns = kBegin_ns + bridge_ahead_ns_ + static_cast<std::int64_t>(tick) * 10'000'000;
    header.epoch = 1;
    return header;
  }
  std::int64_t bridge_ahead_ns_;
  bus::Bus plant_{runtime::memory_options(network_, "plant", crane_SOURCE_PLANT)};
  bus::Bus friction_{runtime::memory_options(network_, "friction_compensation", crane_SOURCE_FRICTION)};
  bus::Bus planner_{runtime::memory_options(network_, "planner", crane_SOURCE_PLANNER)};
  bus::Publisher<msg::State> states_ = plant_.publisher(topics::state);
  bus::Publisher<msg::Demand> demands_ = friction_.publisher(topics::demand);
  bus::Publisher<msg::Reference> references_ = planner_.publisher(topics::reference);
  bus::Subscriber<msg::SupervisorStatus> statuses_ = planner_.subscriber(topics::supervisor);
  configuration::Rig rig_;
  bus::Bus bus_{runtime::memory_options(network_, "crane_supervisor", crane_SOURCE_SUPERVISOR)};
  runtime::HostedComponent hosted_{bus_, supervisor_spec(), rig_, runtime::chosen_controller("", rig_),
                                   runtime::Clock::realtime};
  runtime::Component* supervisor_ = &hosted_.component();
  msg::SupervisorStatus status_{};
  int steps_ = 0;
};

}  // namespace crane::supervisor
