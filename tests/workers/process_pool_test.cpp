#include "crane/workers/process_pool.hpp"

#include <gmock/gmock.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <map>
#include <set>
#include <stdexcept>

namespace crane::workers {
namespace {

/// Results that arrived from each task.
struct Returned {
  std::map<std::size_t, std::vector<std::string>> records;
  std::map<std::size_t, std::string> failures;  ///< failure of every task that has ended
};

Returned returned_by(std::size_t count, std::size_t at_a_time,
                     const std::function<void(std::size_t, const Outbox&)>& work) {
  Returned all;
  run({.count = count,
       .at_a_time = at_a_time,
       .work = work,
       .take = [&](std::size_t task, std::string record) { all.records[task].push_back(std::move(record)); },
       .ended = [&](std::size_t task, const std::string& failure) { all.failures[task] = failure; }});
  return all;
}

TEST(ProcessPool, GivesTheSameRecordsForAnyNumberOfProcesses) {
  const auto square = [](std::size_t task, const Outbox& outbox) {
    outbox.send(std::to_string(task));
    outbox.send(std::to_string(task * task));
  };
  for (const std::size_t at_a_time : {1U, 2U, 7U}) {
    const auto all = returned_by(50, at_a_time, square);
    ASSERT_EQ(all.records.size(), 50U);
    for (const auto& [task, records] : all.records)
      EXPECT_THAT(records, testing::ElementsAre(std::to_string(task), std::to_string(task * task)));
    for (const auto& [task, failure] : all.failures) EXPECT_EQ(failure, "") << task;
  }
}

TEST(ProcessPool, CarriesRecordsThatAreLargerThanAPipe) {
  const auto all = returned_by(
      3, 3, [](std::size_t task, const Outbox& outbox) { outbox.send(std::string(1'000'000 + task, 'x')); });
  for (std::size_t task = 0; task < 3; ++task)
    EXPECT_EQ(all.records.at(task).front(), std::string(1'000'000 + task, 'x'));
}

TEST(ProcessPool, CarriesEmptyRecordsAndNoRecords) {
  const auto all = returned_by(2, 1, [](std::size_t task, const Outbox& outbox) {
    if (task == 0) outbox.send("");
  });
  EXPECT_THAT(all.records.at(0), testing::ElementsAre(""));
  EXPECT_FALSE(all.records.contains(1));
  EXPECT_EQ(all.failures.size(), 2U);
}

TEST(ProcessPool, ACrashAffectsOnlyItsTask) {
  const auto all = returned_by(6, 2, [](std::size_t task, const Outbox& outbox) {
    outbox.send("begun");
    if (task == 2) ::raise(SIGKILL);
    if (task == 3) throw std::runtime_error("3");
    if (task == 4) ::_exit(7);
    outbox.send("done");
  });
  EXPECT_EQ(all.failures.at(2), "signal 9");
  EXPECT_EQ(all.failures.at(3), "exit code 1");
  EXPECT_EQ(all.failures.at(4), "exit code 7");
  for (const std::size_t task : {2U, 3U, 4U})
    EXPECT_THAT(all.records.at(task), testing::ElementsAre("begun"));
  for (const std::size_t task : {0U, 1U, 5U}) {
    EXPECT_THAT(all.records.at(task), testing::ElementsAre("begun", "done"));
    EXPECT_EQ(all.failures.at(task), "");
  }
}

TEST(ProcessPool, ATaskMayForkProcessesThatSend) {
  const auto all = returned_by(2, 2, [](std::size_t /*task*/, const Outbox& outbox) {
    for (const char* text : {"a", "b"}) {
      const pid_t child = ::fork();
      if (child == 0) {
        outbox.send(text);
        ::_exit(0);
      }
      ::waitpid(child, nullptr, 0);
    }
  });
  for (const auto& [task, records] : all.records)
    EXPECT_THAT(records, testing::ElementsAre("a", "b")) << task;
}

/// Counters that all processes see.
struct Shared {
  std::atomic<int> now{0}, most{0}, begun{0};
};

class SharedMemory {
 public:
  SharedMemory()
      : place_{::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)} {
    if (place_ == MAP_FAILED) throw std::runtime_error("mmap");
    new (place_) Shared;
  }
  ~SharedMemory() { ::munmap(place_, sizeof(Shared)); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  Shared* operator->() const { return static_cast<Shared*>(place_); }

 private:
  void* place_;
};

TEST(ProcessPool, RunsNoMoreThanPermittedAtATime) {
  const SharedMemory shared;
  (void)returned_by(20, 3, [&](std::size_t /*task*/, const Outbox& /*outbox*/) {
    ++shared->begun;
    const int now = ++shared->now;
    for (int most = shared->most; most < now && !shared->most.compare_exchange_weak(most, now);) {
    }
    --shared->now;
  });
  EXPECT_EQ(shared->begun, 20);
  EXPECT_GE(shared->most, 1);
  EXPECT_LE(shared->most, 3);
}

TEST(ProcessPool, CancellationKillsRunningTasksAndStartsNoFurtherTask) {
  const SharedMemory shared;
  std::size_t taken = 0;
  run({.count = 1000,
       .at_a_time = 2,
       .work =
           [&](std::size_t task, const Outbox& outbox) {
             ++shared->begun;
             if (task == 1) ::pause();  // the task waits until it is killed
             outbox.send("x");
           },
       .take = [&](std::size_t /*task*/, const std::string& /*record*/) { ++taken; },
       .cancelled = [&] { return taken >= 5; }});
  EXPECT_GE(taken, 5U);
  EXPECT_LT(shared->begun, 20);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a process was left";
}

TEST(ProcessPool, PassesOnExceptionsOfTheReceiverAndLeavesNoProcess) {
  EXPECT_THROW(run({.count = 4,
                    .at_a_time = 4,
                    .work =
                        [](std::size_t task, const Outbox& outbox) {
                          if (task != 0) ::pause();
                          outbox.send("x");
                        },
                    .take = [](std::size_t, const std::string&) { throw std::runtime_error("disk full"); }}),
               std::runtime_error);
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a process was left";
}

TEST(ProcessPool, RunsNothingWithoutTasks) {
  EXPECT_TRUE(returned_by(0, 4, [](std::size_t, const Outbox&) { ::_exit(1); }).failures.empty());
}

TEST(ProcessPool, FindsAtLeastOneProcessor) { EXPECT_GE(processors(), 1U); }

}  // namespace
}  // namespace crane::workers
