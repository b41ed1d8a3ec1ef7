#include "stack/child_processes.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace crane::stack {
namespace {

std::string describe(int status) {
  if (WIFEXITED(status)) return "exit code " + std::to_string(WEXITSTATUS(status));
  if (WIFSIGNALED(status))
    return "signal " + std::to_string(WTERMSIG(status)) + " (" + ::strsignal(WTERMSIG(status)) + ")";
  return "status " + std::to_string(status);
}

/// Runs between fork and exec; only async-signal-safe calls are permitted.
[[noreturn]] void become(const char* program, char* const* arguments, pid_t parent, int inherited) {
  ::setpgid(0, 0);  // Ctrl-C then reaches only the parent, which stops the stack in order
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(1);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);  // standard output contains only the result of the parent's command
  // Closes sockets of the DDS library and descriptors of the caller of `crane up`, which have no FD_CLOEXEC.
  ::close_range(STDERR_FILENO + 1, ~0U, CLOSE_RANGE_CLOEXEC);
  if (inherited >= 0) ::fcntl(inherited, F_SETFD, 0);
  ::execv(program, arguments);
  ::_exit(127);
}

}  // namespace

std::filesystem::path program_directory() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

void ChildProcesses::start(const std::string& name, const std::string& program,
                           const std::vector<std::string>& arguments, int inherited) {
  const std::string path = (program_directory() / program).string();
  if (::access(path.c_str(), X_OK) != 0)
    throw std::runtime_error(path + ": " + std::strerror(errno) + "; build the project first");
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const auto parent = ::getpid();
  const auto pid = ::fork();
  if (pid < 0) throw std::runtime_error("cannot start " + program + ": " + std::strerror(errno));
  if (pid == 0) become(path.c_str(), argv.data(), parent, inherited);
  children_.push_back({name, pid});
}

std::optional<Ended> ChildProcesses::ended() {
  for (auto& child : children_) {
    int status = 0;
    if (!child.running || ::waitpid(child.pid, &status, WNOHANG) != child.pid) continue;
    child.running = false;
    return Ended{child.name, describe(status), WIFEXITED(status) ? WEXITSTATUS(status) : -1};
  }
  return std::nullopt;
}

void ChildProcesses::stop(std::chrono::milliseconds patience) noexcept {
  for (const auto& child : children_)
    if (child.running) {
      ::kill(child.pid, SIGTERM);
      ::kill(child.pid, SIGCONT);  // a stopped process handles SIGTERM only after SIGCONT
    }
  const auto deadline = std::chrono::steady_clock::now() + patience;
  for (auto& child : children_) {
    while (child.running && ::waitpid(child.pid, nullptr, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > deadline) ::kill(child.pid, SIGKILL);
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    }
    child.running = false;
  }
  children_.clear();
}

std::optional<pid_t> ChildProcesses::pid_of(const std::string& name) const {
  for (const auto& child : children_)
    if (child.running && child.name == name) return child.pid;
  return std::nullopt;
}

}  // namespace crane::stack
