/// Another program tries to drive the crane in the session of an operator's stick. The program knows all data
/// on an open bus: client, request id, start-up number, tick.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "../system/running_stack.hpp"
#include "crane/runtime/node.hpp"

namespace crane::hostile {
namespace {

using namespace std::chrono_literals;
using system_test::RunningStack;

constexpr std::uint32_t kDomain = 70, kEpoch = 4711;
constexpr double kStill_m = 0.01;  ///< motion of an axis by swing and control
constexpr const char* kClient = "operator 1";

runtime::BusOptions on_this_crane(const std::string& vendor) {
  runtime::BusOptions options;
  options.vendor = vendor;
  options.domain = kDomain;
  options.crane = system_test::crane_name();
  return options;
}

/// A program with a bus of its own that requests sessions of the stick, and writes samples of any session.
class Stick {
 public:
  explicit Stick(const std::string& vendor)
      : bus_{runtime::bus_options(on_this_crane(vendor), "stick", crane_SOURCE_OPERATOR, kEpoch)},
        requests_{bus_.publisher(topics::request)},
        replies_{bus_.subscriber(topics::reply)},
        jogs_{bus_.publisher(topics::jog)} {}

  /// True: the supervisor and the plant read requests, both reply, and the supervisor reads the stick.
  [[nodiscard]] bool connected() const {
    return requests_.matched() >= 2 && replies_.matched() >= 2 && jogs_.matched() >= 1;
  }
  void request(std::uint64_t id, const msg::Header& seen) {
    msg::Request request{};
    request.header = runtime::answer_to(seen);
    request.id = id;
    runtime::assign(request.client, kClient);
    request.kind = crane_REQUEST_JOG;
    request.selected[0] = true;
    ASSERT_TRUE(requests_.publish(request));
  }
  [[nodiscard]] bool accepted(std::uint64_t id) {
    while (const auto reply = replies_.take())
      if (reply->request_id == id && reply->accepted) return true;
    return false;
  }
  void deflect(std::uint64_t id, std::uint64_t tick, double share) { send(id, tick, true, share); }
  void release(std::uint64_t id, std::uint64_t tick) { send(id, tick, false, 0); }

 private:
  void send(std::uint64_t id, std::uint64_t tick, bool engaged, double share) {
    msg::Jog sample{};
    sample.header.tick = tick;
    sample.request_id = id;
    runtime::assign(sample.client, kClient);
    sample.engaged = engaged;
    sample.deflection[0] = share;
    (void)jogs_.publish(sample);
  }

  bus::Bus bus_;
  bus::Publisher<msg::Request> requests_;
  bus::Subscriber<msg::Reply> replies_;
  bus::Publisher<msg::Jog> jogs_;
};

/// The parameter is the DDS vendor of the supervisor's counterpart.
class JogAttack : public testing::TestWithParam<std::string> {
 protected:
  JogAttack() {
    stack_.session().arm();
    EXPECT_TRUE(stack_.until([&] { return operator_->connected() && stranger_.connected(); }, 8s));
  }
  void begin_session(std::uint64_t id) {
    operator_->request(id, stack_.session().status()->header);
    ASSERT_TRUE(stack_.until([&] { return operator_->accepted(id); }, 2s));
    stack_.forget();
  }
  [[nodiscard]] std::uint64_t tick() { return stack_.session().state()->header.tick; }
  void attack_for(std::chrono::milliseconds duration, const std::function<void()>& attack) {
    (void)stack_.until(
        [&] {
          attack();
          return false;
        },
        duration);
  }
  [[nodiscard]] double largest_deflection() const {
    double largest = 0;
    for (const auto& status : stack_.observer().statuses())
      largest = std::max(largest, std::abs(status.jog_deflection[0]));
    return largest;
  }
  void expect_nothing_moved() {
    const auto& states = stack_.observer().states();
    ASSERT_GT(states.size(), 20U);
    EXPECT_NEAR(states.front().trolley_position_m, states.back().trolley_position_m, kStill_m);
    EXPECT_EQ(largest_deflection(), 0);
  }

  RunningStack stack_{kDomain, "virginia_tech_tower"};
  std::optional<Stick> operator_{GetParam()};
  Stick stranger_{GetParam()};
};

TEST_P(JogAttack, OfACopyThatSendsFirstDoesNotWinTheSession) {
  begin_session(7);
  attack_for(400ms, [&] { stranger_.deflect(7, tick(), 1); });
  expect_nothing_moved();
}

TEST_P(JogAttack, OfACopyThatSendsFirstLeavesTheSessionToItsOperator) {
  begin_session(7);
  attack_for(200ms, [&] { stranger_.deflect(7, tick(), -1); });
  attack_for(1s, [&] {
    stranger_.deflect(7, tick(), -1);
    operator_->deflect(7, tick(), 0.5);
  });
  const auto& statuses = stack_.observer().statuses();
  EXPECT_TRUE(
      std::ranges::all_of(statuses, [](const auto& status) { return status.jog_deflection[0] >= 0; }));
  EXPECT_EQ(statuses.back().jog_deflection[0], 0.5);
}

TEST_P(JogAttack, OfACopyThatContinuesTheSessionOfADeadOperatorMovesNothing) {
  begin_session(7);
  operator_.reset();
  attack_for(400ms, [&] { stranger_.deflect(7, tick(), 1); });
  expect_nothing_moved();
}

TEST_P(JogAttack, OfAFloodMovesNothing) {
  begin_session(7);
  int sent = 0;
  attack_for(1s, [&] {
    operator_->deflect(7, tick(), 0);
    for (int i = 0; i < 100; ++i, ++sent) stranger_.deflect(7, tick(), 1);
  });
  std::cout << sent << " samples in 1 s\n";
  expect_nothing_moved();
  const auto state = stack_.observer().statuses().back().state;
  EXPECT_TRUE(state == crane_STATE_RUN || state == crane_STATE_HOLD) << state;
}

TEST_P(JogAttack, OfAFloodDoesNotDelayTheRelease) {
  begin_session(7);
  attack_for(500ms, [&] { operator_->deflect(7, tick(), 0.5); });
  ASSERT_EQ(stack_.observer().statuses().back().jog_deflection[0], 0.5);
  attack_for(300ms, [&] {
    operator_->release(7, tick());
    for (int i = 0; i < 100; ++i) stranger_.deflect(7, tick(), 1);
  });
  EXPECT_EQ(stack_.observer().statuses().back().jog_deflection[0], 0);
}

TEST_P(JogAttack, WithSamplesOfAnEndedSessionStartsNothing) {
  begin_session(7);
  attack_for(200ms, [&] { operator_->deflect(7, tick(), 0); });
  operator_->release(7, tick());
  ASSERT_TRUE(
      stack_.until([&] { return stack_.observer().statuses().back().state == crane_STATE_HOLD; }, 5s));
  stack_.forget();
  attack_for(500ms, [&] {
    for (auto* stick : {&*operator_, &stranger_}) stick->deflect(7, tick(), 1);
  });
  expect_nothing_moved();
}

TEST_P(JogAttack, ByASecondOperatorEndsTheFirstSessionAndActsWithTheSecondRequestOnly) {
  begin_session(7);
  stranger_.request(8, stack_.session().status()->header);
  ASSERT_TRUE(stack_.until([&] { return stranger_.accepted(8); }, 2s));
  stack_.forget();
  attack_for(300ms, [&] {
    operator_->deflect(7, tick(), 1);
    operator_->deflect(8, tick(), 1);
  });
  expect_nothing_moved();
}

INSTANTIATE_TEST_SUITE_P(Vendors, JogAttack, testing::Values("cyclone", "fastdds"),
                         [](const auto& vendor) { return vendor.param; });

}  // namespace
}  // namespace crane::hostile
