// A session resets the crane only after a routine stop, and ends when another operator moves the crane. A
// scripted supervisor answers over the memory bus.
#include "experiments/realtime_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "crane/runtime/node.hpp"
#include "crane/runtime/process.hpp"
#include "crane/supervisor/states.hpp"

namespace crane::experiments {
namespace {

bus::Options options_on(const std::shared_ptr<bus::MemoryNetwork>& network, const char* name,
                        crane_Source source) {
  bus::Options options;
  options.vendor = bus::Vendor::memory;
  options.network = network;
  options.participant = name;
  options.source = source;
  return options;
}

/// Publishes LOCKED until a first reset arrives, refuses this reset, and then publishes `stopped`. Accepts
/// each later reset, as the supervisor does in ESTOP.
class ScriptedSupervisor {
 public:
  ScriptedSupervisor(const std::shared_ptr<bus::MemoryNetwork>& network, crane_SupervisorState stopped_state,
                     crane_Cause stopped_cause)
      : bus_{options_on(network, "supervisor", crane_SOURCE_SUPERVISOR)},
        stopped_state_{stopped_state},
        stopped_cause_{stopped_cause},
        thread_{[this] { run(); }} {}
  ~ScriptedSupervisor() { end(); }
  void end() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
  }

  [[nodiscard]] int resets() const { return resets_; }
  [[nodiscard]] int arms() const { return arms_; }

 private:
  void run() {
    while (!ends_) {
      msg::SupervisorStatus status{};
      status.header.tick = ++tick_;
      status.header.sample_time_ns = runtime::monotonic_ns();
      status.state = resets_ > 1 ? crane_STATE_READY : resets_ == 1 ? stopped_state_ : crane_STATE_LOCKED;
      status.cause = resets_ > 1 ? crane_CAUSE_NONE : resets_ == 1 ? stopped_cause_ : crane_CAUSE_START;
      EXPECT_TRUE(statuses_.publish(status));
      bus_.wait(std::chrono::milliseconds{10});
      while (const auto request = requests_.take()) answer(*request);
    }
  }
  void answer(const msg::Request& request) {
    msg::Reply reply{};
    reply.request_id = request.id;
    runtime::assign(reply.client, request.client);
    runtime::assign(reply.reason, "a limit switch is pressed");
    if (request.kind == crane_REQUEST_RESET) reply.accepted = ++resets_ > 1;
    if (request.kind == crane_REQUEST_ARM) ++arms_;
    EXPECT_TRUE(replies_.publish(reply));
  }

  bus::Bus bus_;
  bus::Subscriber<msg::Request> requests_ = bus_.subscriber(topics::request);
  bus::Subscriber<msg::Request> requests_of_a_recorder_ = bus_.subscriber(topics::request);
  bus::Publisher<msg::Reply> replies_ = bus_.publisher(topics::reply);
  bus::Publisher<msg::SupervisorStatus> statuses_ = bus_.publisher(topics::supervisor);
  crane_SupervisorState stopped_state_;
  crane_Cause stopped_cause_;
  std::uint64_t tick_ = 0;
  std::atomic<int> resets_ = 0, arms_ = 0;
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

struct Stop {
  crane_SupervisorState state;
  crane_Cause cause;
  const char* text;
};

class SessionBeforeItsFirstReset : public testing::TestWithParam<Stop> {};

TEST_P(SessionBeforeItsFirstReset, EndsAtAStopThatIsNotRoutineAndDoesNotResetIt) {
  const auto network = bus::make_memory_network();
  ScriptedSupervisor supervisor{network, GetParam().state, GetParam().cause};
  bus::Bus bus{options_on(network, "session", crane_SOURCE_OPERATOR)};
  RealtimeSession session{bus, [] {}};
  session.end_at_stops();
  try {
    session.arm();
    ADD_FAILURE() << "the session armed the crane";
  } catch (const SessionError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(GetParam().text));
  }
  supervisor.end();
  EXPECT_EQ(supervisor.resets(), 1);
  EXPECT_EQ(supervisor.arms(), 0);
}

INSTANTIATE_TEST_SUITE_P(
    By, SessionBeforeItsFirstReset,
    testing::Values(
        Stop{crane_STATE_ESTOP, crane_CAUSE_ESTOP_INPUT, "ESTOP because of ESTOP_INPUT"},
        Stop{crane_STATE_FAULT, crane_CAUSE_RELAY_DID_NOT_OPEN, "FAULT because of RELAY_DID_NOT_OPEN"},
        Stop{crane_STATE_LOCKED, crane_CAUSE_BRIDGE_RESTARTED, "LOCKED because of BRIDGE_RESTARTED"},
        Stop{crane_STATE_LOCKED, crane_CAUSE_OPERATOR_STOP, "LOCKED because of OPERATOR_STOP"}),
    [](const auto& test) {
      return std::string{crane::supervisor::name_of(static_cast<crane::supervisor::Cause>(test.param.cause))};
    });

/// Accepts every request and executes every move within kMoveTicks. `Replaced` states when the move of
/// another operator begins.
class SharedSupervisor {
 public:
  enum class Replaced { never, during_the_move, in_the_same_tick, in_hold };

  SharedSupervisor(const std::shared_ptr<bus::MemoryNetwork>& network, Replaced replaced)
      : bus_{options_on(network, "supervisor", crane_SOURCE_SUPERVISOR)},
        replaced_{replaced},
        thread_{[this] { run(); }} {}
  ~SharedSupervisor() { end(); }
  void end() {
    ends_ = true;
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] int moves() const { return moves_; }
  [[nodiscard]] int ticks() const { return ticks_; }
  void reset_by_another() { is_reset_ = true; }

 private:
  static constexpr int kMoveTicks = 10;

  void run() {
    while (!ends_) {
      if (is_reset_.exchange(false)) status_.state = crane_STATE_READY;
      if (moving_ticks_ > 0 && --moving_ticks_ == 0) status_.state = crane_STATE_HOLD;
      if (replaced_ == Replaced::during_the_move && moving_ticks_ == kMoveTicks / 2) begin_of_another();
      if (replaced_ == Replaced::in_hold && moves_ == 1 && moving_ticks_ == 0) begin_of_another();
      status_.header.sample_time_ns = runtime::monotonic_ns();
      ++status_.header.tick;
      EXPECT_TRUE(statuses_.publish(status_));
      msg::State state{};
      state.header = status_.header;
      EXPECT_TRUE(states_.publish(state));
      ++ticks_;
      bus_.wait(std::chrono::milliseconds{10});
      while (const auto request = requests_.take()) answer(*request);
    }
  }
  void begin(std::uint64_t id) {
    status_.state = crane_STATE_RUN;
    ++status_.move.number;
    status_.move.request_id = id;
    moving_ticks_ = kMoveTicks;
  }
  void begin_of_another() {
    begin(1);
    replaced_ = Replaced::never;
  }
  void answer(const msg::Request& request) {
    msg::Reply reply{};
    reply.request_id = request.id;
    runtime::assign(reply.client, request.client);
    reply.accepted = true;
    if (request.kind == crane_REQUEST_RESET) status_.state = crane_STATE_READY;
    if (request.kind == crane_REQUEST_ARM) status_.state = crane_STATE_HOLD;
    if (request.kind == crane_REQUEST_DISARM) status_.state = crane_STATE_LOCKED;
    const bool moves = request.kind == crane_REQUEST_MOVE && request.id != 0;
    if (moves) begin(request.id), ++moves_;
    if (moves && replaced_ == Replaced::in_the_same_tick) begin_of_another();
    status_.cause = status_.state == crane_STATE_LOCKED ? crane_CAUSE_START : crane_CAUSE_NONE;
    EXPECT_TRUE(replies_.publish(reply));
  }

  bus::Bus bus_;
  bus::Subscriber<msg::Request> requests_ = bus_.subscriber(topics::request);
  bus::Subscriber<msg::Request> requests_of_a_recorder_ = bus_.subscriber(topics::request);
  bus::Publisher<msg::Reply> replies_ = bus_.publisher(topics::reply);
  bus::Publisher<msg::SupervisorStatus> statuses_ = bus_.publisher(topics::supervisor);
  bus::Publisher<msg::State> states_ = bus_.publisher(topics::state);
  msg::SupervisorStatus status_ = [] {
    msg::SupervisorStatus locked{};
    locked.state = crane_STATE_LOCKED;
    locked.cause = crane_CAUSE_START;
    return locked;
  }();
  Replaced replaced_;
  int moving_ticks_ = 0;
  std::atomic<int> moves_ = 0, ticks_ = 0;
  std::atomic<bool> ends_ = false, is_reset_ = false;
  std::thread thread_;
};

/// The next run must not take the crane back.
TEST(SessionAfterItsDisarm, NoticesTheResetOfAnotherOperator) {
  const auto network = bus::make_memory_network();
  SharedSupervisor supervisor{network, SharedSupervisor::Replaced::never};
  bus::Bus bus{options_on(network, "session", crane_SOURCE_OPERATOR)};
  RealtimeSession session{bus, [] {}};
  session.end_at_stops();
  session.arm();
  session.disarm();
  EXPECT_EQ(session.status()->state, crane_STATE_LOCKED);
  session.wait(std::chrono::milliseconds{50});
  EXPECT_FALSE(session.taken_over());
  supervisor.reset_by_another();
  session.wait(std::chrono::milliseconds{100});
  EXPECT_TRUE(session.taken_over());
}

/// @return the reason for which the session ended before its second move was executed; empty: it did not end
std::string drive_twice(const std::shared_ptr<bus::MemoryNetwork>& network) {
  bus::Bus bus{options_on(network, "session", crane_SOURCE_OPERATOR)};
  RealtimeSession session{bus, [] {}};
  session.end_at_stops();
  try {
    session.arm();
    for (const double target_m : {0.5, 0.6}) {
      session.move_to({true, false, false}, {target_m, 0, 0}, std::chrono::seconds{5});
      session.wait(std::chrono::milliseconds{100});
    }
  } catch (const SessionError& error) {
    return error.what();
  }
  return "";
}

class SessionWhoseMoveIsReplaced : public testing::TestWithParam<SharedSupervisor::Replaced> {};

TEST_P(SessionWhoseMoveIsReplaced, EndsWithoutAnotherMove) {
  const auto network = bus::make_memory_network();
  SharedSupervisor supervisor{network, GetParam()};
  EXPECT_THAT(drive_twice(network), testing::HasSubstr("replaced by a later move"));
  supervisor.end();
  EXPECT_EQ(supervisor.moves(), 1);
}

INSTANTIATE_TEST_SUITE_P(By, SessionWhoseMoveIsReplaced,
                         testing::Values(SharedSupervisor::Replaced::during_the_move,
                                         SharedSupervisor::Replaced::in_the_same_tick,
                                         SharedSupervisor::Replaced::in_hold));

constexpr std::int64_t kLater_ns = 100'000'000;
constexpr std::chrono::milliseconds kLate{50};

TEST(SessionAlone, EndsWhenTheLastStatesOfAMotionDoNotArrive) {
  const auto network = bus::make_memory_network();
  SharedSupervisor supervisor{network, SharedSupervisor::Replaced::never};
  bus::Bus bus{options_on(network, "session", crane_SOURCE_OPERATOR)};
  RealtimeSession session{bus, [] {}};
  session.arm();
  supervisor.end();
  EXPECT_THROW(session.wait_for_sample(runtime::monotonic_ns() + kLater_ns, kLate), SessionError);
}

TEST(SessionAlone, TakesTheStatesThatArrivedWhileItWasSuspended) {
  const auto network = bus::make_memory_network();
  SharedSupervisor supervisor{network, SharedSupervisor::Replaced::never};
  bus::Bus bus{options_on(network, "session", crane_SOURCE_OPERATOR)};
  bool suspended = false;
  RealtimeSession session{bus, [&] {
                            if (!std::exchange(suspended, false)) return;
                            for (const int begin = supervisor.ticks(); supervisor.ticks() < begin + 50;)
                              std::this_thread::yield();
                          }};
  session.arm();
  const auto end_ns = runtime::monotonic_ns() + kLater_ns;
  suspended = true;
  EXPECT_NO_THROW(session.wait_for_sample(end_ns, kLate));
  EXPECT_GE(session.state()->header.sample_time_ns, end_ns);
}

TEST(SessionAlone, ReplacesItsOwnMoves) {
  const auto network = bus::make_memory_network();
  SharedSupervisor supervisor{network, SharedSupervisor::Replaced::never};
  EXPECT_EQ(drive_twice(network), "");
  bus::Bus bus{options_on(network, "session", crane_SOURCE_OPERATOR)};
  RealtimeSession session{bus, [] {}};
  session.end_at_stops();
  session.wait(std::chrono::milliseconds{50});
  for (int i = 0; i < 20; ++i)
    session.request({.kind = crane_REQUEST_MOVE, .selected = {true, false, false}}, "move");
  session.wait(std::chrono::milliseconds{50});
  supervisor.end();
  EXPECT_EQ(supervisor.moves(), 22);
}

}  // namespace
}  // namespace crane::experiments
