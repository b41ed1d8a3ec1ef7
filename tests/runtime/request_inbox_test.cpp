// Requests wait for their tick in bounded memory.
#include "crane/runtime/request_inbox.hpp"

#include <gtest/gtest.h>

#include <string>

#include "crane/runtime/in_process.hpp"

namespace crane::runtime {
namespace {

class Inbox : public testing::Test {
 protected:
  explicit Inbox(Clock clock = Clock::lockstep) : clock_{clock} {}

  void send(std::uint64_t id, std::uint64_t apply_tick, crane_RequestKind kind = crane_REQUEST_STOP) {
    msg::Request request{};
    request.id = id;
    request.kind = kind;
    request.header.tick = seen_tick_;
    request.apply_tick = apply_tick;
    ASSERT_TRUE(requests_.publish(request));
  }
  std::size_t refusals() {
    std::size_t count = 0;
    while (const auto reply = replies_.take()) count += reply->accepted ? 0 : 1;
    return count;
  }

  std::uint64_t seen_tick_ = 0;
  Clock clock_;
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();
  bus::Bus operator_{memory_options(network_, "operator", crane_SOURCE_OPERATOR)};
  bus::Publisher<msg::Request> requests_ = operator_.publisher(topics::request);
  bus::Subscriber<msg::Reply> replies_ = operator_.subscriber(topics::reply);
  bus::Bus own_{memory_options(network_, "supervisor", crane_SOURCE_SUPERVISOR)};
  ComponentSpec spec_{.name = "supervisor",
                      .program = "",
                      .summary = "",
                      .source = crane_SOURCE_SUPERVISOR,
                      .runs_controller = false,
                      .reads = {{&topics::request.description, ""}},
                      .writes = {{&topics::reply.description, ""}},
                      .make = nullptr};
  const control::Controller& none_ = *control::find_controller("none");
  control::Design design_;
  Ports ports_{own_, spec_, none_, design_, clock_};
  Node node_{own_, {"supervisor", ""}};
  configuration::Rig rig_;
  RequestInbox inbox_{{ports_, node_, rig_, none_, own_.options(), clock_},
                      {crane_REQUEST_STOP, crane_REQUEST_ARM}};
};

TEST_F(Inbox, IgnoresRequestsOfAProcessThatMayNotWriteThem) {
  for (const auto source :
       {crane_SOURCE_NONE, crane_SOURCE_SUPERVISOR, crane_SOURCE_MONITOR, crane_SOURCE_TWIN}) {
    bus::Bus stranger{memory_options(network_, "stranger", source)};
    auto requests = stranger.publisher(topics::request);
    msg::Request request{};
    request.id = 1;
    request.kind = crane_REQUEST_STOP;
    ASSERT_TRUE(requests.publish(request));
    EXPECT_FALSE(inbox_.receive()) << "source " << source;
  }
  send(2, 0);
  EXPECT_TRUE(inbox_.receive());
  EXPECT_EQ(inbox_.take_due(0)->id, 2U);
  EXPECT_FALSE(inbox_.take_due(0));
}

TEST_F(Inbox, ReturnsARequestAtItsTickAndNotBefore) {
  send(1, 20);
  send(2, 0);
  inbox_.receive();
  EXPECT_EQ(inbox_.take_due(19)->id, 2U);
  EXPECT_FALSE(inbox_.take_due(19));
  EXPECT_EQ(inbox_.take_due(20)->id, 1U);
}

TEST_F(Inbox, RefusesARequestForATickThatIsHoursAhead) {
  send(1, ~std::uint64_t{0});
  inbox_.receive();
  EXPECT_FALSE(inbox_.take_due(5));
  EXPECT_EQ(refusals(), 1U);
  send(2, 5 + RequestInbox::kFarthest_ticks);
  inbox_.receive();
  EXPECT_FALSE(inbox_.take_due(5));
  EXPECT_EQ(refusals(), 0U);
}

TEST_F(Inbox, AFloodFillsNeitherItsMemoryNorATick) {
  for (std::uint64_t id = 1; id <= 1000; ++id) send(id, 500'000);
  int calls = 0;
  while (inbox_.receive()) ++calls;
  EXPECT_GE(calls, 1000 / 64);
  EXPECT_EQ(refusals(), 1000 - RequestInbox::kMostWaiting);
}

TEST_F(Inbox, AFloodOfScheduledRequestsDoesNotBlockAStop) {
  for (std::uint64_t id = 1; id <= 1000; ++id) send(id, 500'000);
  while (inbox_.receive()) {
  }
  send(2000, 0);
  inbox_.receive();
  const auto stop = inbox_.take_due(1);
  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->id, 2000U);
}

class InboxInRealTime : public Inbox {
 protected:
  InboxInRealTime() : Inbox{Clock::realtime} {}
};

TEST_F(InboxInRealTime, RefusesARequestForALaterTickSoThatNothingMovesAfterItsOperatorHasLeft) {
  send(1, 20, crane_REQUEST_ARM);
  inbox_.receive();
  EXPECT_EQ(refusals(), 1U);
  for (std::uint64_t tick = 1; tick < 30; ++tick) EXPECT_FALSE(inbox_.take_due(tick));
}

/// A connection that was lost for some seconds delivers a request after its operator has given up.
TEST_F(InboxInRealTime, RefusesARequestThatArrivesMoreThanTwoSecondsAfterItsOperatorSawTheCrane) {
  constexpr std::uint64_t kSeen = 1000, kTwoSeconds = 200;
  seen_tick_ = kSeen;
  for (const auto tick : {kSeen - kTwoSeconds - 1, kSeen + kTwoSeconds + 1}) {
    send(1, 0, crane_REQUEST_ARM);
    inbox_.receive();
    EXPECT_FALSE(inbox_.take_due(tick)) << tick;
    EXPECT_EQ(refusals(), 1U);
  }
  for (const auto tick : {kSeen - kTwoSeconds, kSeen + kTwoSeconds}) {
    send(2, 0, crane_REQUEST_ARM);
    inbox_.receive();
    EXPECT_TRUE(inbox_.take_due(tick)) << tick;
  }
}

TEST_F(InboxInRealTime, RefusesARequestWhoseOperatorNamesNoTick) {
  seen_tick_ = 0;
  send(1, 0, crane_REQUEST_ARM);
  inbox_.receive();
  EXPECT_FALSE(inbox_.take_due(1'000'000));
  EXPECT_EQ(refusals(), 1U);
}

TEST_F(InboxInRealTime, AStopActsHoweverOldItIs) {
  for (seen_tick_ = 0; seen_tick_ < 2; ++seen_tick_) {
    send(1, 0);
    inbox_.receive();
    EXPECT_TRUE(inbox_.take_due(1'000'000));
  }
}

TEST_F(Inbox, InLockstepHasNoAgeLimitBecauseTimePassesOnlyWithTheTicks) {
  seen_tick_ = 1;
  send(1, 0, crane_REQUEST_ARM);
  inbox_.receive();
  EXPECT_TRUE(inbox_.take_due(10'000));
}

TEST_F(InboxInRealTime, AStopForALaterTickActsAtOnce) {
  send(1, 500'000);
  inbox_.receive();
  EXPECT_TRUE(inbox_.take_due(1));
  EXPECT_EQ(refusals(), 0U);
}

}  // namespace
}  // namespace crane::runtime
