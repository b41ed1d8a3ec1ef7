/// Requests, moves and sessions of the stick of `crane`, over the memory bus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "cli/move_follower.hpp"
#include "cli/operator_request.hpp"
#include "cli/stick_session.hpp"
#include "memory_bus.hpp"

namespace crane::cli {
namespace {

using testing::HasSubstr;

class OperatorTool : public testing::Test {
 protected:
  std::shared_ptr<bus::MemoryNetwork> network_ = bus::make_memory_network();
  bus::Bus crane_ = bus_on(network_, crane_SOURCE_SUPERVISOR);
  bus::Bus tool_ = bus_on(network_, crane_SOURCE_OPERATOR);
};

/// ends_early: its last reference of a move is not the target.
enum class Planner : std::uint8_t { absent, deaf, ends_early, listening };

/// A process that gives the same answer to every request, remains in HOLD, and publishes the status of a
/// supervisor and the reference of a planner.
class FakeSupervisor {
 public:
  FakeSupervisor(bus::Bus& bus, bool accepts, Planner planner = Planner::absent)
      : bus_{bus}, thread_{[this, accepts, planner] { run(accepts, planner); }} {}
  ~FakeSupervisor() {
    done_ = true;
    thread_.join();
  }
  FakeSupervisor(const FakeSupervisor&) = delete;
  FakeSupervisor& operator=(const FakeSupervisor&) = delete;

 private:
  void run(bool accepts, Planner planner) {
    auto requests = bus_.subscriber(topics::request);
    auto replies = bus_.publisher(topics::reply);
    auto statuses = bus_.publisher(topics::supervisor);
    auto references = bus_.publisher(topics::reference);
    msg::SupervisorStatus status{};
    status.state = crane_STATE_HOLD;
    msg::Reference reference{};
    while (!done_) {
      EXPECT_TRUE(statuses.publish(status));
      if (planner != Planner::absent) {
        EXPECT_TRUE(references.publish(reference));
      }
      bus_.wait(std::chrono::milliseconds{1});
      while (const auto request = requests.take()) {
        msg::Reply reply{};
        reply.request_id = request->id;
        runtime::assign(reply.client, request->client);
        reply.accepted = accepts;
        runtime::assign(reply.reason, accepts ? "" : "the crane is LOCKED");
        EXPECT_TRUE(replies.publish(reply));
        if (accepts) {
          status.move.request_id = request->id;
          ++status.move.number;
          status.move.kind = request->kind;
          std::ranges::copy(request->selected, status.move.selected);
          std::ranges::copy(request->target, status.move.target);
        }
        if (!accepts || planner == Planner::deaf) continue;
        reference.move_number = status.move.number;
        for (std::size_t i = 0; planner == Planner::listening && i < std::size(reference.axis); ++i)
          reference.axis[i].position = request->target[i];
      }
    }
  }
  bus::Bus& bus_;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

TEST_F(OperatorTool, RequestIsAnsweredByTheSupervisor) {
  const FakeSupervisor supervisor{crane_, true};
  EXPECT_TRUE(ask(tool_, {.kind = crane_REQUEST_ARM}, {.find_s = 10, .reply_s = 10}).accepted);
  EXPECT_TRUE(ask(tool_, {.kind = crane_REQUEST_STOP}, {.find_s = 10, .reply_s = 10}).accepted);
}

TEST_F(OperatorTool, RefusalCarriesItsReason) {
  const FakeSupervisor supervisor{crane_, false};
  const auto answer = ask(tool_, {.kind = crane_REQUEST_ARM}, {.find_s = 10, .reply_s = 10});
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(answer.reason, "the crane is LOCKED");
}

TEST_F(OperatorTool, SessionOfTheStickIsNotRequestedBeforeAStateHasArrived) {
  const FakeSupervisor supervisor{crane_, true, Planner::listening};
  auto requests = crane_.subscriber(topics::request);
  StickSession session{tool_};
  EXPECT_THROW((void)session.begin({true, false, false}, {.find_s = 0.05, .reply_s = 10}), NoAnswer);
  EXPECT_FALSE(requests.take());
}

TEST_F(OperatorTool, EverySampleOfTheStickContainsTheTickOfAState) {
  const FakeSupervisor supervisor{crane_, true, Planner::listening};
  auto jogs = crane_.subscriber(topics::jog);
  auto states = crane_.publisher(topics::state);
  StickSession session{tool_};
  msg::State state{};
  state.header.tick = 4711;
  ASSERT_TRUE(states.publish(state));
  ASSERT_TRUE(session.begin({true, false, false}, {.find_s = 10, .reply_s = 10}).accepted);
  session.drive(
      0.05, false,
      [] {
        return Deflection{1, 0, 0};
      },
      [] { return false; });
  int samples = 0;
  for (; const auto sample = jogs.take(); ++samples) EXPECT_EQ(sample->header.tick, 4711U);
  EXPECT_GT(samples, 0);
}

TEST_F(OperatorTool, RequestWithoutASupervisorNamesTheSearchedCrane) {
  EXPECT_THAT([&] { (void)ask(tool_, {.kind = crane_REQUEST_ARM}, {.find_s = 0.01, .reply_s = 0.01}); },
              testing::ThrowsMessage<NoAnswer>(
                  testing::AllOf(HasSubstr("'crane'"), HasSubstr("domain 0"), HasSubstr("--interface"))));
}

constexpr Patience kPatience{.find_s = 10, .reply_s = 10};
const stack::OperatorRequest kMove{.kind = crane_REQUEST_MOVE, .selected = {true}, .target = {1.0}};

TEST_F(OperatorTool, MoveEndsWhenThePlannerHasExecutedItAndTheCraneIsInHold) {
  const FakeSupervisor supervisor{crane_, true, Planner::listening};
  MoveFollower follower{tool_};
  EXPECT_NO_THROW(follower.follow(ask(tool_, kMove, kPatience).id, 10));
}

TEST_F(OperatorTool, MoveThatThePlannerDoesNotReceiveFails) {
  const FakeSupervisor supervisor{crane_, true, Planner::deaf};
  MoveFollower follower{tool_};
  const auto id = ask(tool_, kMove, kPatience).id;
  EXPECT_THAT([&] { follower.follow(id, 10); }, testing::ThrowsMessage<std::runtime_error>(HasSubstr(
                                                    "the trajectory planner has not executed the move")));
}

TEST_F(OperatorTool, MoveThatThePlannerEndsBeforeTheTargetFails) {
  const FakeSupervisor supervisor{crane_, true, Planner::ends_early};
  MoveFollower follower{tool_};
  const auto id = ask(tool_, kMove, kPatience).id;
  EXPECT_THAT([&] { follower.follow(id, 10); },
              testing::ThrowsMessage<std::runtime_error>(testing::AllOf(
                  HasSubstr("ended before the target"), HasSubstr("trolley axis is 0 m instead of 1 m"))));
}

TEST_F(OperatorTool, MoveOfAnAxisThatRestsAwayFromItsTargetFails) {
  const FakeSupervisor supervisor{crane_, true, Planner::listening};
  MoveFollower follower{tool_};
  auto states = crane_.publisher(topics::state);
  msg::State state{};
  state.trolley_position_m = 0.7;
  ASSERT_TRUE(states.publish(state));
  const auto id = ask(tool_, kMove, kPatience).id;
  EXPECT_THAT([&] { follower.follow(id, 10); },
              testing::ThrowsMessage<std::runtime_error>(HasSubstr("is at 0.7 m instead of 1 m")));
}

TEST(MoveFollowing, DistinguishesALaterMoveFromARestartedSupervisor) {
  msg::AcceptedMove present{};
  present.number = 8;
  EXPECT_EQ(reason_of_replacement(7, present), "replaced by a later move");
  present.number = 0;
  EXPECT_THAT(reason_of_replacement(7, present), HasSubstr("the supervisor has restarted"));
}

TEST(Patience, OfARequestThatStopsIsLongerWithKeys) {
  for (const auto kind : {crane_REQUEST_STOP, crane_REQUEST_ESTOP, crane_REQUEST_DISARM})
    EXPECT_EQ(patience_for(kind, true).find_s, 30);
  EXPECT_EQ(patience_for(crane_REQUEST_MOVE, true).find_s, Patience{}.find_s);
  EXPECT_EQ(patience_for(crane_REQUEST_ESTOP, false).find_s, Patience{}.find_s);
}

TEST_F(OperatorTool, MoveIsNotSentBeforeThePlannerIsFound) {
  const FakeSupervisor supervisor{crane_, true, Planner::absent};
  EXPECT_THAT([&] { (void)ask(tool_, kMove, {.find_s = 0.2, .reply_s = 10}); },
              testing::ThrowsMessage<NoAnswer>(HasSubstr("no trajectory planner")));
}

}  // namespace
}  // namespace crane::cli
