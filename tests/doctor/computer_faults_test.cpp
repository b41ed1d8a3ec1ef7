/// Faults of the computer of a crane, and the findings of the doctor: a stopped process, a user without
/// rights, a late timer, a missing board.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <atomic>
#include <condition_variable>
#include <csignal>
#include <fstream>
#include <mutex>
#include <stop_token>
#include <thread>

#include "../recording/temporary_directory.hpp"
#include "../system/program_run.hpp"
#include "../system/running_stack.hpp"
#include "crane/configuration/rig.hpp"
#include "doctor/hardware.hpp"
#include "doctor/real_time.hpp"
#include "finding_lines.hpp"
#include "stack/data_files.hpp"

namespace crane::doctor {
namespace {

using namespace std::chrono_literals;
using hosts::Answer;
using testing::Contains;
using testing::HasSubstr;

constexpr std::uint32_t kStackDomain = 88;

TEST(OnOneComputer, AStoppedProcessIsNamedAndAWholeStackIsGood) {
  system_test::RunningStack stack{kStackDomain, "virginia_tech_tower"};
  const auto ask = [&] {
    const auto ended =
        system_test::run_program(stack::program_directory() / "crane",
                                 {"doctor", "--net", "--json", "--domain", std::to_string(kStackDomain),
                                  "--crane", system_test::crane_name()});
    return Answer{.exit_code = ended.exit_code, .output = ended.output, .errors = {}};
  };
  const auto healthy = ask();
  EXPECT_THAT(lines(healthy), Contains(HasSubstr("6 processes are heard")));
  EXPECT_EQ(healthy.exit_code, 0) << healthy.output;
  stack.send("anti_swing", SIGSTOP);
  EXPECT_THAT(lines(ask()), Contains(testing::AllOf(HasSubstr("process_stopped: crane_anti_swing"),
                                                    HasSubstr("kill -CONT"))));
  stack.send("anti_swing", SIGCONT);
}

TEST(OnOneComputer, AUserWithoutRightsMayNotScheduleInRealTime) {
  if (::geteuid() != 0) GTEST_SKIP() << "needs root, to give rights up";
  const auto answer =
      hosts::run("prlimit --memlock=65536 setpriv --reuid=65534 --regid=65534 --clear-groups " +
                 (stack::program_directory() / "crane").string() + " doctor --rt --json --duration 0.5");
  EXPECT_EQ(answer.exit_code, 1);
  const auto all = lines(answer);
  EXPECT_THAT(all, Contains(HasSubstr("no_realtime_scheduling")));
  EXPECT_THAT(all, Contains(HasSubstr("memory_not_locked")));
}

/// Occupies the processor several times for longer than the loop tolerates, with a priority above that of the
/// loop.
class Hog {
 public:
  [[nodiscard]] bool granted() const { return granted_; }

 private:
  void run(const std::stop_token& stop) {
    const sched_param parameters{.sched_priority = 95};
    granted_ = ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
    std::unique_lock lock{mutex_};
    while (!stopped_.wait_for(lock, stop, 90ms, [&stop] { return stop.stop_requested(); })) {
      const auto end = std::chrono::steady_clock::now() + 8ms;
      while (std::chrono::steady_clock::now() < end) {
      }
    }
  }

  std::atomic<bool> granted_{false};
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::jthread thread_{[this](const std::stop_token& stop) { run(stop); }};
};

TEST(OnOneComputer, ALateTimerIsAProblemAboveTheToleranceOfTheLoop) {
  cpu_set_t before, one;
  ASSERT_EQ(::sched_getaffinity(0, sizeof before, &before), 0);
  CPU_ZERO(&one);
  CPU_SET(0, &one);
  ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);  // its threads inherit it
  constexpr double kPeriod_s = 0.01;
  {
    const Hog hog;
    const auto late = measure_lateness(kPeriod_s, 1s, 50);
    if (!hog.granted()) GTEST_SKIP() << "SCHED_FIFO is not permitted";
    EXPECT_GT(late.overruns, 0U) << late.max_us;
    EXPECT_THAT(lines(judge_lateness(late, kPeriod_s)), Contains(HasSubstr("timer_late")));
  }
  ::sched_setaffinity(0, sizeof before, &before);
}

TEST(OnOneComputer, AMissingBoardIsNamed) {
  const recording::TemporaryDirectory directory;
  std::ofstream{directory / "rig.toml"} << "extends = \"" << stack::find_rig("virginia_tech_tower").string()
                                        << "\"\nname = \"bench\"\nboard = \"comedi\"\n[wiring]\ndevice = "
                                           "\"/dev/comedi_that_is_not_there\"\n";
  const auto found = lines(examine_board(configuration::load_rig((directory / "rig.toml").string())));
  EXPECT_THAT(found, Contains(testing::AllOf(HasSubstr("board_missing: /dev/comedi_that_is_not_there"),
                                             HasSubstr("modprobe"))));
}

}  // namespace
}  // namespace crane::doctor
