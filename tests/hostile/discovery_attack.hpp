#pragma once
/// A stack without keys, and packets to its processes. Such packets need no DDS implementation; the attacker
/// chooses identifiers, locators and lease.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "../system/running_stack.hpp"
#include "forged.hpp"
#include "loop_processes.hpp"
#include "wire.hpp"

namespace crane::hostile {

using namespace std::chrono_literals;
using system_test::RunningStack;

inline constexpr const char* kDiscoveryRig = "virginia_tech_tower";
class DiscoveryAttack : public testing::Test {
 protected:
  static constexpr std::uint32_t kDomain = 89;
  static constexpr double kStill_m = 0.01;  ///< motion of an axis in HOLD by swing and control

  void SetUp() override {
    if (!Ear::permitted()) GTEST_SKIP() << "listening on the loop-back interface needs CAP_NET_RAW";
    start("");
  }
  void start(const std::string& keys, bool ledger = true) {
    stack_.reset();
    stack_.emplace(kDomain, kDiscoveryRig, stack::Plant::simulated, keys, "cyclone", ledger);
    ASSERT_TRUE(stack_->until([this] { return is(crane_STATE_LOCKED); }, 10s));
    stack_->listen(1s);  // the supervisor refuses a reset in its first second
  }
  [[nodiscard]] bool is(crane_SupervisorState state) const {
    const auto& statuses = stack_->observer().statuses();
    return !statuses.empty() && statuses.back().state == state;
  }
  [[nodiscard]] std::set<std::uint16_t> ports(const char* process) {
    const auto pid = stack_->children().pid_of(process);
    return pid ? ports_of(*pid) : std::set<std::uint16_t>{};
  }
  /// A packet to `process` for which `wanted` holds.
  template <class Wanted>
  Packet heard(const char* process, const Wanted& wanted) {
    const auto own = ports(process);
    Ear ear;
    const auto end = std::chrono::steady_clock::now() + 5s;
    while (std::chrono::steady_clock::now() < end)
      if (auto packet = ear.next(20ms); packet && own.contains(packet->port()) && wanted(packet->message))
        return *packet;
    throw std::runtime_error("no such packet heard");
  }
  template <class T>
  Packet heard(const char* process, const topics::Topic<T>& topic) {
    return heard(process, [&](Bytes& message) { return find(message, topic).has_value(); });
  }
  void send_to(const char* process, const Bytes& message) {
    Packet packet;
    packet.to.sin_family = AF_INET;
    packet.to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    packet.message = message;
    for (const auto port : ports(process)) {
      packet.to.sin_port = htons(port);
      mouth_.send(packet);
    }
  }
  [[nodiscard]] std::map<std::string, long> memory_kb() {
    std::map<std::string, long> all;
    for (const char* process : kLoop)
      if (const auto pid = stack_->children().pid_of(process)) all[process] = resident_kb(*pid);
    return all;
  }
  void expect_nothing_moved() const {
    const auto& states = stack_->observer().states();
    ASSERT_GT(states.size(), 50U);
    for (const auto& state : states)
      for (std::size_t i = 0; i < 2; ++i)
        ASSERT_TRUE(state.applied_v[i] == 0 && state.brake_closed[i]) << "tick " << state.header.tick;
    EXPECT_EQ(states.front().trolley_position_m, states.back().trolley_position_m);
  }
  /// HOLD, or 0 V with closed brakes; the crane has not moved.
  void expect_hold_or_stop() const {
    const auto& states = stack_->observer().states();
    ASSERT_FALSE(states.empty());
    for (const auto& state : states)
      ASSERT_NEAR(state.trolley_position_m, states.front().trolley_position_m, kStill_m);
    const auto& last = states.back();
    EXPECT_TRUE(is(crane_STATE_HOLD) || (last.brake_closed[0] && last.brake_closed[1] &&
                                         last.applied_v[0] == 0 && last.applied_v[1] == 0));
    const auto& status = stack_->observer().statuses().back();
    std::cout << experiments::in_words(status) << "; overruns " << last.overruns - states.front().overruns
              << '\n';
  }
  void expect_growth_below(long most_kb, const std::map<std::string, long>& before_kb) {
    for (const auto& [process, kb] : memory_kb()) {
      std::cout << process << ": memory grew by " << kb - before_kb.at(process) << " kB\n";
      EXPECT_LE(kb - before_kb.at(process), most_kb) << process;
    }
  }

  std::optional<RunningStack> stack_;
  Mouth mouth_;
};

}  // namespace crane::hostile
