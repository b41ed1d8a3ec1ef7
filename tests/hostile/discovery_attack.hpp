#pragma once
/// A stack without keys, and packets to its processes. Such packets need no DDS implementation; the attacker
/// chooses identifiers, locators and lease.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>

#include "../system/running_stack.hpp"
#include "copied_writer.hpp"
#include "forged.hpp"
#include "loop_processes.hpp"
#include "wire.hpp"

namespace crane::hostile {

using namespace std::chrono_literals;
using system_test::RunningStack;

inline constexpr const char* kDiscoveryRig = "virginia_tech_tower";
class DiscoveryAttack : public testing::Test {
 protected:
  static constexpr std::uint32_t kDomain = CRANE_ATTACKED_DOMAIN;
  static constexpr double kStill_m = 0.01;  ///< motion of an axis in HOLD by swing and control

  void SetUp() override {
    if (!Ear::permitted()) GTEST_SKIP() << "listening on the loop-back interface needs CAP_NET_RAW";
    start(default_options());
  }
  static stack::LaunchOptions default_options() {
    return system_test::launch_options(kDomain, kDiscoveryRig);
  }
  static stack::LaunchOptions without_ledger() {
    auto options = default_options();
    options.ledger = nullptr;
    return options;
  }
  void start(const stack::LaunchOptions& options, stack::Plant plant = stack::Plant::simulated) {
    stack_.reset();
    stack_.emplace(options, plant);
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
  /// Forges `spoil`ed samples for every tick of the bridge, and with extreme ticks and times, for a second.
  /// @param bus   of the attacker: tells it the ticks
  /// @param copy  makes the CopiedWriter
  template <class Copy, class Spoil>
  void forge(bus::Bus& bus, const Copy& copy, const Spoil& spoil) {
    auto states = bus.subscriber(topics::state);
    ASSERT_TRUE(stack_->until([&] { return states.take().has_value(); }, 5s));
    const auto copied = copy();
    auto& forged = *copied;
    const auto send = [&](std::uint64_t tick, std::int64_t time_ns) {
      auto sample = forged.model();
      spoil(sample);
      sample.header.tick = tick;
      sample.header.sample_time_ns = time_ns;
      forged.send(sample);
    };
    stack_->forget();
    const auto end = std::chrono::steady_clock::now() + 1s;
    while (std::chrono::steady_clock::now() < end) {
      bus.wait(2ms);
      while (const auto state = states.take()) {
        const auto& now = state->header;
        for (const std::uint64_t ahead : {0, 1}) send(now.tick + ahead, now.sample_time_ns);
        if (now.tick % 10 != 0) continue;
        using Times = std::numeric_limits<std::int64_t>;
        for (const auto time_ns : {Times::min(), std::int64_t{0}, Times::max()})
          for (const auto tick : {std::uint64_t{0}, now.tick, std::numeric_limits<std::uint64_t>::max()})
            send(tick, time_ns);
      }
      stack_->listen(0ms);
    }
    stack_->listen(300ms);
    std::cout << forged.sent() << " packets; ";
  }
  [[nodiscard]] std::map<std::string, long> memory_kb() {
    std::map<std::string, long> all;
    for (const char* process : kLoop)
      if (const auto pid = stack_->children().pid_of(process)) all[process] = resident_kb(*pid);
    return all;
  }
  using States = std::vector<msg::State>;
  [[nodiscard]] const States& states() const { return stack_->observer().states(); }
  static void expect_nothing_moved(const States& states) {
    ASSERT_GT(states.size(), 50U);
    for (const auto& state : states)
      for (std::size_t i = 0; i < 2; ++i)
        ASSERT_TRUE(state.applied_v[i] == 0 && state.brake_closed[i]) << "tick " << state.header.tick;
    EXPECT_EQ(states.front().trolley_position_m, states.back().trolley_position_m);
  }
  /// Largest distance of the trolley from its first position.
  [[nodiscard]] static double farthest_m(const States& states) {
    double farthest = 0;
    for (const auto& state : states)
      farthest = std::max(farthest, std::abs(state.trolley_position_m - states.front().trolley_position_m));
    return farthest;
  }
  /// 0 V and closed brakes.
  [[nodiscard]] static bool stands(const msg::State& state) {
    return state.brake_closed[0] && state.brake_closed[1] && state.applied_v[0] == 0 &&
           state.applied_v[1] == 0;
  }
  /// Time from the first state to the first one with 0 V and closed brakes [ms]; the last state when there is
  /// none.
  [[nodiscard]] static double stop_ms(const States& states) {
    const auto stop = std::ranges::find_if(states, stands);
    const auto& last = stop == states.end() ? states.back() : *stop;
    return static_cast<double>(last.header.sample_time_ns - states.front().header.sample_time_ns) / 1e6;
  }
  /// HOLD, or 0 V with closed brakes; the crane has not moved.
  void expect_hold_or_stop() const {
    ASSERT_FALSE(states().empty());
    EXPECT_LE(farthest_m(states()), kStill_m);
    const auto& last = states().back();
    EXPECT_TRUE(is(crane_STATE_HOLD) || stands(last));
    const auto& status = stack_->observer().statuses().back();
    std::cout << "trolley moved by " << farthest_m(states()) << " m; "
              << (stands(last)
                      ? "brakes closed after " + std::to_string(std::lround(stop_ms(states()))) + " ms; "
                      : "brakes open; ")
              << experiments::in_words(status) << "; overruns " << last.overruns - states().front().overruns
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
