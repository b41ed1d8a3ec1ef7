#include "crane/runtime/turn.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <latch>
#include <stdexcept>
#include <thread>
#include <vector>

#include "crane/runtime/process.hpp"

namespace {

using crane::runtime::Component;
using crane::runtime::kNever;
using crane::runtime::monotonic_ns;
using crane::runtime::Turn;

constexpr std::int64_t kHour_ns = 3'600'000'000'000;

/// A component whose step is a function of the test.
class Steps final : public Component {
 public:
  explicit Steps(std::function<bool()> step) : step_{std::move(step)} {}
  [[nodiscard]] std::string_view name() const override { return "steps"; }
  bool poll(std::int64_t /*now_ns*/) override { return step_(); }
  [[nodiscard]] std::int64_t wake_at_ns() const override { return wake_at_ns_; }
  [[nodiscard]] std::string waiting_for() const override { return "nothing"; }
  std::int64_t wake_at_ns_ = kNever;

 private:
  std::function<bool()> step_;
};

TEST(ATurn, RunsTheComponentInTheThreadThatAsks) {
  std::thread::id ran_in;
  Steps component{[&] {
    ran_in = std::this_thread::get_id();
    return false;
  }};
  Turn turn{monotonic_ns};
  turn.begin(component, 0);
  EXPECT_EQ(ran_in, std::this_thread::get_id());
  std::thread receiver{[&] { turn.run(); }};
  const auto receiver_id = receiver.get_id();
  receiver.join();
  EXPECT_EQ(ran_in, receiver_id);
  turn.end();
}

TEST(ATurn, PollsUntilTheComponentHasNothingToProcess) {
  int left = 5;
  Steps component{[&] { return --left > 0; }};
  Turn turn{monotonic_ns};
  turn.begin(component, 0);
  EXPECT_EQ(left, 0);
  turn.end();
}

TEST(ATurn, DoesNotMakeAThreadWaitForTheRunningOne) {
  std::latch inside{1}, leave{1};
  int polls = 0;  // written by the running thread only
  Steps component{[&] {
    if (++polls != 2) return false;
    inside.count_down();
    leave.wait();
    return false;
  }};
  Turn turn{monotonic_ns};
  turn.begin(component, 0);
  std::thread running{[&] { turn.run(); }};
  inside.wait();
  std::thread receiver{[&] { turn.run(); }};
  receiver.join();  // ends although the component still runs
  leave.count_down();
  running.join();
  EXPECT_EQ(polls, 3) << "the running thread serves the request of the other thread";
  turn.end();
}

TEST(ATurn, LosesNoRequestAndRunsOneThreadAtATime) {
  constexpr int kThreads = 4, kRequests = 20'000;
  std::atomic<int> arrived = 0, inside = 0, overlaps = 0;
  int processed = 0;
  Steps component{[&] {
    if (inside.fetch_add(1) != 0) ++overlaps;
    const int taken = arrived.exchange(0);
    processed += taken;
    inside.fetch_sub(1);
    return taken > 0;
  }};
  Turn turn{monotonic_ns};
  turn.begin(component, 0);
  std::vector<std::thread> receivers;
  for (int i = 0; i < kThreads; ++i)
    receivers.emplace_back([&] {
      for (int k = 0; k < kRequests; ++k) {
        ++arrived;
        turn.run();
      }
    });
  for (auto& receiver : receivers) receiver.join();
  turn.end();
  EXPECT_EQ(overlaps, 0);
  EXPECT_EQ(processed, kThreads * kRequests);
}

TEST(ATurn, WakesTheMainThreadWhenTheComponentNeedsAnEarlierTime) {
  std::atomic<int> polls = 0;
  Steps component{[&] {
    ++polls;
    return false;
  }};
  Turn turn{monotonic_ns};
  turn.begin(component, 0);
  std::thread receiver{[&] {
    component.wake_at_ns_ = 0;  // due at once; the main thread sleeps for an hour, or is about to
    turn.run();
  }};
  turn.wait(kHour_ns);
  receiver.join();
  EXPECT_EQ(polls, 2);
  turn.end();
}

TEST(ATurn, EndsTheWaitWhenItIsWoken) {
  Steps component{[] { return false; }};
  Turn turn{monotonic_ns};
  turn.begin(component, 0);
  turn.wake();
  turn.wait(kHour_ns);
  std::thread receiver{[&] { turn.wake(); }};
  turn.wait(kHour_ns);
  receiver.join();
  turn.end();
}

TEST(ATurn, PassesTheExceptionOfTheComponentToTheMainThreadAndEndsTheComponent) {
  int polls = 0;
  Steps component{[&]() -> bool {
    if (++polls == 2) throw std::runtime_error{"a board without an answer"};
    return false;
  }};
  Turn turn{monotonic_ns};
  turn.begin(component, 0);
  std::thread receiver{[&] { turn.run(); }};
  receiver.join();
  turn.run();
  EXPECT_EQ(polls, 2);
  EXPECT_THROW(turn.wait(kHour_ns), std::runtime_error);
}

TEST(ATurn, EndsOnlyWhenNoThreadRunsTheComponent) {
  std::latch inside{1}, leave{1};
  std::atomic<bool> left = false;
  int polls = 0;
  Steps component{[&] {
    if (++polls != 2) return false;
    inside.count_down();
    leave.wait();
    left = true;
    return false;
  }};
  Turn turn{monotonic_ns};
  turn.begin(component, 0);
  std::thread running{[&] { turn.run(); }};
  inside.wait();
  std::thread opener{[&] { leave.count_down(); }};
  turn.end();
  EXPECT_TRUE(left);
  opener.join();
  running.join();
  turn.run();
  EXPECT_EQ(polls, 2) << "after end() the component is not polled";
}

}  // namespace
