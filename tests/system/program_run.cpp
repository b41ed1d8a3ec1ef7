#include "program_run.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace crane::system_test {
namespace {

using std::chrono::steady_clock;

struct Pipe {
  int read = -1, write = -1;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("cannot create a pipe");
  return {ends[0], ends[1]};
}

int milliseconds_until(steady_clock::time_point time) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - steady_clock::now());
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

/// Appends the available output. @return false at the end of the stream
bool append_from(int descriptor, std::string& text) {
  std::array<char, 4096> part{};
  const auto n = ::read(descriptor, part.data(), part.size());
  if (n > 0) text.append(part.data(), static_cast<std::size_t>(n));
  return n > 0 || (n < 0 && errno == EINTR);
}

}  // namespace

ProgramRun::ProgramRun(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  const auto path = program.string();
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const auto output = make_pipe();
  const auto errors = make_pipe();
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("cannot start " + path);
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    ::dup2(output.write, STDOUT_FILENO);
    ::dup2(errors.write, STDERR_FILENO);
    ::execv(path.c_str(), argv.data());
    ::_exit(127);
  }
  ::close(output.write);
  ::close(errors.write);
  output_pipe_ = output.read;
  error_pipe_ = errors.read;
}

ProgramRun::~ProgramRun() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  if (output_pipe_ >= 0) ::close(output_pipe_);
  if (error_pipe_ >= 0) ::close(error_pipe_);
}

void ProgramRun::send(int signal) const {
  if (pid_ > 0) ::kill(pid_, signal);
}

bool ProgramRun::read_some(steady_clock::time_point give_up) {
  std::array<pollfd, 2> waits{pollfd{output_pipe_, POLLIN, 0}, pollfd{error_pipe_, POLLIN, 0}};
  if (output_pipe_ < 0 && error_pipe_ < 0) return false;
  if (::poll(waits.data(), waits.size(), milliseconds_until(give_up)) <= 0) return false;
  const auto take = [](const pollfd& wait, int& descriptor, std::string& text) {
    if (wait.revents == 0 || append_from(descriptor, text)) return;
    ::close(descriptor);
    descriptor = -1;
  };
  take(waits[0], output_pipe_, output_);
  take(waits[1], error_pipe_, errors_);
  return true;
}

bool ProgramRun::wait_for(const std::string& text, std::chrono::milliseconds patience) {
  const auto give_up = steady_clock::now() + patience;
  while (output_.find(text) == std::string::npos)
    if (!read_some(give_up)) return false;
  return true;
}

bool ProgramRun::wait_for_error(const std::string& text, std::chrono::milliseconds patience) {
  const auto give_up = steady_clock::now() + patience;
  while (errors_.find(text) == std::string::npos)
    if (!read_some(give_up)) return false;
  return true;
}

std::optional<int> ProgramRun::wait(std::chrono::milliseconds patience) {
  const auto give_up = steady_clock::now() + patience;
  while (read_some(give_up)) {
  }
  if (!wait_for_end({pid_}, std::chrono::milliseconds{milliseconds_until(give_up)})) return std::nullopt;
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = 0;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

Ended run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
  ProgramRun run{program, arguments};
  const auto exit_code = run.wait(std::chrono::seconds{30});
  return {exit_code.value_or(-1), run.output(), run.errors()};
}

std::vector<pid_t> processes_with(const std::string& text) {
  std::vector<pid_t> pids;
  for (const auto& entry : std::filesystem::directory_iterator{"/proc"}) {
    const auto name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream in{entry.path() / "cmdline", std::ios::binary};
    const std::string line{std::istreambuf_iterator<char>{in}, {}};
    const auto pid = static_cast<pid_t>(std::stol(name));
    if (pid != ::getpid() && line.find(text) != std::string::npos) pids.push_back(pid);
  }
  std::sort(pids.begin(), pids.end());
  return pids;
}

bool wait_for_end(const std::vector<pid_t>& pids, std::chrono::milliseconds patience) {
  const auto give_up = steady_clock::now() + patience;
  bool all = true;
  for (const auto pid : pids) {
    const auto descriptor = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
    if (descriptor < 0) continue;  // the stream has ended
    pollfd wait{descriptor, POLLIN, 0};
    all = ::poll(&wait, 1, milliseconds_until(give_up)) > 0 && all;
    ::close(descriptor);
  }
  return all;
}

}  // namespace crane::system_test
