#pragma once
/// An armed crane in HOLD without keys, and what a foreign program may not change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include "../system/running_stack.hpp"
#include "loop_processes.hpp"
#include "wire.hpp"

namespace crane::hostile {

using namespace std::chrono_literals;
using system_test::RunningStack;

class ArmedCrane : public testing::Test {
 protected:
  static constexpr std::uint32_t kDomain = 84;
  static constexpr double kStill_m = 0.01;  ///< motion of an axis in HOLD by swing and control
  static constexpr long kGrowth_kb = 8 * 1024;

  explicit ArmedCrane(std::uint32_t domain = kDomain) : stack_{domain, "virginia_tech_tower"} {
    stack_.session().arm();
    stack_.forget();
    for (const char* process : kLoop) before_kb_[process] = resident_kb(pid_of(process).value());
  }
  [[nodiscard]] std::optional<pid_t> pid_of(const std::string& process) const {
    return stack_.children().pid_of(process);
  }
  [[nodiscard]] runtime::BusOptions options(const std::string& vendor = "cyclone") const {
    auto options = stack_.bus_options();
    options.vendor = vendor;
    return options;
  }
  void attack_for(std::chrono::milliseconds duration, const std::function<void()>& attack) {
    (void)stack_.until(
        [&] {
          attack();
          return false;
        },
        duration);
  }
  void expect_no_motion() const {
    const auto& states = stack_.observer().states();
    ASSERT_GT(states.size(), 50U);
    for (const auto& state : states)
      ASSERT_NEAR(state.trolley_position_m, states.front().trolley_position_m, kStill_m);
  }
  void expect_hold() {
    stack_.listen(200ms);
    const auto& statuses = stack_.observer().statuses();
    EXPECT_EQ(statuses.back().state, crane_STATE_HOLD) << experiments::in_words(statuses.back());
    expect_no_motion();
    EXPECT_FALSE(stack_.children().ended());
  }
  void expect_little_growth() const {
    for (const auto& [process, kb] : before_kb_)
      EXPECT_LE(resident_kb(pid_of(process).value()) - kb, kGrowth_kb) << process;
  }

  mutable RunningStack stack_;
  std::map<std::string, long> before_kb_;
};

}  // namespace crane::hostile
