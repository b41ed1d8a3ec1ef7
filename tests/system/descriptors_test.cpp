/// Descriptors of the processes of a stack. A process inherits standard input, output and errors; a process
/// of the loop also inherits the ledger. It inherits no socket of `crane up` and no file of the caller.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <map>
#include <set>

#include "../recording/temporary_directory.hpp"
#include "program_run.hpp"
#include "running_stack.hpp"
#include "stack/child_processes.hpp"

namespace crane::system_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDescriptorsDomain = 90;
constexpr const char* kLedgerFile = "/memfd:crane_ledger (deleted)";

std::string program_of(pid_t pid) {
  return std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/exe").filename();
}

/// Files, sockets and pipes of a process, without the standard descriptors. A ledger has the number of its
/// anonymous file: `crane` creates a ledger, which it uses only when it starts a stack.
std::set<std::string> descriptors_of(pid_t pid) {
  std::set<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator{"/proc/" + std::to_string(pid) + "/fd"}) {
    std::error_code closed;
    std::string target = std::filesystem::read_symlink(entry.path(), closed);
    struct stat file {};
    if (closed || std::stoi(entry.path().filename()) <= STDERR_FILENO) continue;
    if (target == kLedgerFile && ::stat(entry.path().c_str(), &file) == 0)
      target += " " + std::to_string(file.st_ino);
    all.insert(target);
  }
  return all;
}

TEST(Descriptors, OfTheProcessesOfAStackAreNotInherited) {
  const recording::TemporaryDirectory directory;
  const auto of_the_caller = (directory / "file_of_the_caller").string();
  const int file = ::open(of_the_caller.c_str(), O_RDWR | O_CREAT, 0600);  // without O_CLOEXEC
  ASSERT_GE(file, 0);
  ProgramRun up{stack::program_directory() / "crane",
                {"up", "--domain", std::to_string(kDescriptorsDomain), "--crane", crane_name(), "--priority",
                 "0", "--plant", "hardware", "--rig", "emulated_servo_to_go", "--dashboard",
                 "--dashboard-port", "0", "--twin", "--record", (directory / "run.mcap").string()}};
  ::close(file);
  ASSERT_TRUE(up.wait_for("is up with", 20s)) << up.errors();
  EXPECT_TRUE(descriptors_of(up.pid()).contains(of_the_caller)) << "this test proves nothing";

  std::map<std::string, std::set<pid_t>> owners;  // of sockets, pipes and ledgers
  std::size_t processes = 0;
  for (const auto pid : processes_with(crane_name())) {
    if (pid != up.pid()) ++processes;
    for (const auto& target : descriptors_of(pid)) {
      if (target.starts_with("socket:") || target.starts_with("pipe:") || target.starts_with(kLedgerFile))
        owners[target].insert(pid);
      if (pid != up.pid()) {
        EXPECT_NE(target, of_the_caller) << program_of(pid);
      }
    }
  }
  EXPECT_GE(processes, 9U);
  std::set<std::string> with_ledger;
  for (const auto& [target, pids] : owners) {
    std::set<std::string> names;
    for (const auto pid : pids) names.insert(pid == up.pid() ? "crane up" : program_of(pid));
    if (target.starts_with(kLedgerFile) && names.contains("crane_supervisor")) {
      with_ledger = names;
    } else {
      EXPECT_EQ(pids.size(), 1U) << target << ": " << testing::PrintToString(names);
    }
  }
  EXPECT_THAT(with_ledger,
              testing::UnorderedElementsAre("crane up", "crane_hardware_bridge", "crane_trajectory_planner",
                                            "crane_tracking", "crane_anti_swing",
                                            "crane_friction_compensation", "crane_supervisor"));
  up.send(SIGINT);
  EXPECT_EQ(up.wait(10s), 0);
}

/// A service may start `crane up` with closed standard descriptors. Files of the stack must not get their
/// numbers: the processes write their messages to descriptor 2.
TEST(Descriptors, OfAClosedStandardErrorLeadToNoFile) {
  ProgramRun up{
      "/bin/sh",
      {"-c", R"(exec "$0" "$@" <&- 2>&-)", (stack::program_directory() / "crane").string(), "up", "--domain",
       std::to_string(kDescriptorsDomain), "--crane", crane_name(), "--priority", "0", "--no-black-box"}};
  ASSERT_TRUE(up.wait_for("is up with", 20s)) << up.output();
  std::size_t processes = 0;
  for (const auto pid : processes_with(crane_name())) {
    ++processes;
    for (const char* descriptor : {"0", "2"})
      EXPECT_EQ(std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/fd/" + descriptor),
                "/dev/null")
          << program_of(pid) << ": descriptor " << descriptor;
  }
  EXPECT_GE(processes, 7U);
  up.send(SIGINT);
  EXPECT_EQ(up.wait(10s), 0);
}

}  // namespace
}  // namespace crane::system_test
