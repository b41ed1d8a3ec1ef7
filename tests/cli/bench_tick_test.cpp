// crane bench tick as a user starts it: the report, wrong arguments, and the end of its processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "../system/program_run.hpp"
#include "stack/child_processes.hpp"

namespace crane::cli {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

const auto kCrane = stack::program_directory() / "crane";
const std::vector<std::string> kBenchTick{"bench", "tick", "--domain", "90"};  // the floors use 91

std::vector<std::string> bench_tick(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), kBenchTick.begin(), kBenchTick.end());
  return arguments;
}

TEST(BenchTick, ReportsPartsThatAddUpBesideFloors) {
  const auto ended = system_test::run_program(kCrane, bench_tick({"--seconds", "1", "--json"}));
  ASSERT_EQ(ended.exit_code, 0) << ended.errors;
  const auto report = nlohmann::json::parse(ended.output);
  EXPECT_GT(report["ticks"], 50);
  double share = 0, hops_us = 0;
  for (const auto& part : report["parts"]) share += part["share"].get<double>();
  EXPECT_NEAR(share, 1, 1e-9);
  for (const auto& hop : report["hops"])
    for (const auto& [part, mean_us] : hop["mean_us"].items())
      hops_us += mean_us.get<double>() * hop["ticks"].get<double>() / report["ticks"].get<double>();
  EXPECT_NEAR(hops_us, report["state_to_command_us"]["mean"], 1e-6 * hops_us);
  ASSERT_EQ(report["floors"].size(), 4U);
  for (const auto& floor : report["floors"]) {
    EXPECT_GT(floor["samples"], 50) << floor;
    EXPECT_GT(floor["p50_us"], 0) << floor;
    EXPECT_GE(floor["p99_us"], floor["p50_us"]) << floor;
  }
  ASSERT_EQ(report["processor"].size(), 6U);
  for (const auto& process : report["processor"]) EXPECT_GT(process["loop"]["running_us"], 0) << process;
}

TEST(BenchTick, RefusesWrongArgumentsAndNamesThem) {
  const auto refused = [](const std::vector<std::string>& arguments) {
    const auto ended = system_test::run_program(kCrane, bench_tick(arguments));
    EXPECT_EQ(ended.exit_code, 2) << ended.output;
    return ended.errors;
  };
  EXPECT_THAT(refused({"--seconds", "0"}), HasSubstr("--seconds: '0' must be a number in [1, 3600]"));
  EXPECT_THAT(refused({"--seconds", "nan"}), HasSubstr("--seconds"));
  EXPECT_THAT(refused({"--priority", "99"}), HasSubstr("--priority"));
  EXPECT_THAT(refused({"--plant", "paper"}), HasSubstr("--plant"));
  EXPECT_THAT(refused({"--rig", "no_such_rig"}), HasSubstr("no_such_rig"));
}

TEST(BenchTick, HelpNamesTheFloors) {
  const auto ended = system_test::run_program(kCrane, bench_tick({"--help"}));
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_THAT(ended.output,
              testing::AllOf(HasSubstr("UDP"), HasSubstr("Cyclone DDS"), HasSubstr("--seconds")));
}

TEST(BenchTick, ItsProcessesEndWhenItIsKilled) {
  constexpr std::size_t kFloorProcesses = 13,
                        kStackProcesses = 7;  // one wakes a thread; the card is a process
  const std::string mark = "1234.5";          // on the command line of all floors
  system_test::ProgramRun run{kCrane, bench_tick({"--seconds", mark})};
  const std::string crane = "bench_" + std::to_string(run.pid());
  const auto give_up = std::chrono::steady_clock::now() + 20s;
  while ((system_test::processes_with(mark).size() < kFloorProcesses + 1 ||
          system_test::processes_with(crane).size() < kStackProcesses) &&
         std::chrono::steady_clock::now() < give_up)
    std::this_thread::sleep_for(10ms);
  ASSERT_EQ(system_test::processes_with(mark).size(), kFloorProcesses + 1);
  const auto stack = system_test::processes_with(crane);
  ASSERT_EQ(stack.size(), kStackProcesses);
  run.send(SIGKILL);
  EXPECT_EQ(run.wait(5s), 128 + SIGKILL);
  EXPECT_TRUE(system_test::wait_for_end(system_test::processes_with(mark), 5s));
  EXPECT_TRUE(system_test::wait_for_end(stack, 5s));
}

}  // namespace
}  // namespace crane::cli
