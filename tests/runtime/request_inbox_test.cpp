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
    request.header = named_;
    request.apply_tick = apply_tick;
    ASSERT_TRUE(requests_.publish(request));
  }
  std::optional<msg::Request> due(std::uint64_t tick) { return inbox_.take_due(tick, now_ns_); }
  std::size_t refusals() {
    std::size_t count = 0;
    while (const auto reply = replies_.take()) count += reply->accepted ? 0 : 1;
    return count;
  }

  msg::Header named_{};
  std::int64_t now_ns_ = 0;
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
  EXPECT_EQ(due(0)->id, 2U);
  EXPECT_FALSE(due(0));
}

TEST_F(Inbox, ReturnsARequestAtItsTickAndNotBefore) {
  send(1, 20);
  send(2, 0);
  inbox_.receive();
  EXPECT_EQ(due(19)->id, 2U);
  EXPECT_FALSE(due(19));
  EXPECT_EQ(due(20)->id, 1U);
}

TEST_F(Inbox, RefusesARequestForATickThatIsHoursAhead) {
  send(1, ~std::uint64_t{0});
  inbox_.receive();
  EXPECT_FALSE(due(5));
  EXPECT_EQ(refusals(), 1U);
  send(2, 5 + RequestInbox::kFarthest_ticks);
  inbox_.receive();
  EXPECT_FALSE(due(5));
  EXPECT_EQ(refusals(), 0U);
}

TEST_F(Inbox, IsBoundedInMemoryAndTimePerTickDuringAFlood) {
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
  const auto stop = due(1);
  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->id, 2000U);
}

/// An inbox of a supervisor whose tick k was latched at kBegin_ns + k periods.
class InboxInRealTime : public Inbox {
 protected:
  static constexpr std::int64_t kBegin_ns = 7'000'000'000, kPeriod_ns = 10'000'000;

  InboxInRealTime() : Inbox{Clock::realtime} {}

  static msg::Header header_of(std::uint64_t tick, std::int64_t begin_ns = kBegin_ns) {
    msg::Header header{};
    header.tick = tick;
    header.sample_time_ns = begin_ns + static_cast<std::int64_t>(tick) * kPeriod_ns;
    return header;
  }
  void run_until(std::uint64_t tick) {
    while (tick_ < tick) step();
  }
  void step() {
    ++tick_;
    now_ns_ = header_of(tick_).sample_time_ns;
    inbox_.stepped(header_of(tick_), now_ns_);
  }
  /// @return true when the inbox returns a request that names the tick of `named`
  bool executes(const msg::Header& named, crane_RequestKind kind = crane_REQUEST_ARM) {
    named_ = named;
    send(++id_, 0, kind);
    inbox_.receive();
    const bool executed = due(tick_).has_value();
    EXPECT_EQ(refusals(), executed ? 0U : 1U);
    return executed;
  }

  std::uint64_t tick_ = 0, id_ = 0;
};

TEST_F(InboxInRealTime, RefusesARequestForALaterTick) {
  run_until(1);
  named_ = header_of(1);
  send(1, 20, crane_REQUEST_ARM);
  inbox_.receive();
  EXPECT_EQ(refusals(), 1U);
  for (; tick_ < 30; step()) EXPECT_FALSE(due(tick_));
}

/// A connection that was lost for seconds may deliver a request after its operator has given up.
TEST_F(InboxInRealTime, RefusesARequestThatArrivesMoreThanTwoSecondsAfterTheTickThatItNames) {
  run_until(1000);
  EXPECT_TRUE(executes(header_of(1000)));
  EXPECT_TRUE(executes(header_of(800)));
  EXPECT_FALSE(executes(header_of(799)));
  EXPECT_FALSE(executes(header_of(1001))) << "a tick that has not begun";
}

/// A supervisor that was suspended finds outdated requests in its queue.
TEST_F(InboxInRealTime, CountsTheTimeInWhichNoTickArrives) {
  run_until(1000);
  now_ns_ += 2'000'000'000;
  EXPECT_TRUE(executes(header_of(1000)));
  now_ns_ += 1;
  EXPECT_FALSE(executes(header_of(1000)));
}

/// DDS Security does not prevent a replay of a recorded request to a supervisor that has restarted.
TEST_F(InboxInRealTime, RefusesARequestOfAnEarlierRunWithTheNumberOfAPresentTick) {
  run_until(500);
  constexpr std::int64_t kYesterday_ns = kBegin_ns - 86'400'000'000'000;
  for (const std::uint64_t tick : {450U, 500U}) EXPECT_FALSE(executes(header_of(tick, kYesterday_ns)));
  EXPECT_TRUE(executes(header_of(450)));
}

TEST_F(InboxInRealTime, RefusesARequestThatNamesATickBeforeTheLastStop) {
  run_until(100);
  inbox_.stopped(now_ns_);
  run_until(150);
  EXPECT_FALSE(executes(header_of(99)));
  EXPECT_TRUE(executes(header_of(100)));
  EXPECT_TRUE(executes(header_of(99), crane_REQUEST_STOP));
}

/// The bridge is silent: the supervisor stops the crane after its newest tick.
TEST_F(InboxInRealTime, RefusesARequestThatNamesTheTickBeforeAStopWithoutATick) {
  run_until(100);
  now_ns_ += 30'000'000;
  inbox_.stopped(now_ns_);
  EXPECT_FALSE(executes(header_of(100)));
}

/// After the restart, the ticks begin at 0 again.
TEST_F(InboxInRealTime, RefusesATickOfTheBridgeBeforeARestart) {
  run_until(5000);
  const auto before = header_of(5000);
  now_ns_ += 400'000'000;
  msg::Header first{};
  first.sample_time_ns = now_ns_;
  inbox_.stepped(first, now_ns_);
  inbox_.stopped(now_ns_);
  EXPECT_FALSE(executes(before));
  EXPECT_TRUE(executes(first));
}

TEST_F(InboxInRealTime, RefusesARequestWhoseOperatorNamesNoTick) {
  run_until(50);
  EXPECT_FALSE(executes({}));
}

TEST_F(InboxInRealTime, AStopOfAnyAgeActs) {
  run_until(1000);
  for (std::uint64_t tick = 0; tick < 2; ++tick) EXPECT_TRUE(executes(header_of(tick), crane_REQUEST_STOP));
}

TEST_F(Inbox, InLockstepHasNoAgeLimitBecauseTimePassesOnlyWithTheTicks) {
  named_.tick = 1;
  send(1, 0, crane_REQUEST_ARM);
  inbox_.receive();
  EXPECT_TRUE(due(10'000));
}

TEST_F(InboxInRealTime, AStopForALaterTickActsAtOnce) {
  send(1, 500'000);
  inbox_.receive();
  EXPECT_TRUE(due(1));
  EXPECT_EQ(refusals(), 0U);
}

}  // namespace
}  // namespace crane::runtime
