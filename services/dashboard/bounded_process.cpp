#include "dashboard/bounded_process.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "crane/runtime/process.hpp"

namespace crane::dashboard {
namespace {

constexpr int kChildNiceness = 19;

void limit(decltype(RLIMIT_AS) what, std::uint64_t value) {
  const rlimit both{.rlim_cur = value, .rlim_max = value};
  ::setrlimit(what, &both);
}

/// Runs between fork and exec; only async-signal-safe calls are permitted.
[[noreturn]] void become(const char* program, char* const* arguments, int output, int errors,
                         const Bounds& bounds, unsigned processors, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const sched_param ordinary{};
  ::sched_setscheduler(0, SCHED_BATCH, &ordinary);
  ::setpriority(PRIO_PROCESS, 0, kChildNiceness);
  limit(RLIMIT_AS, bounds.memory_bytes);
  limit(RLIMIT_CPU, static_cast<std::uint64_t>(bounds.time.count()) * processors);
  limit(RLIMIT_FSIZE, bounds.largest_file_bytes);
  limit(RLIMIT_CORE, 0);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::close_range(STDERR_FILENO + 1, ~0U, 0);  // the child must not inherit the sockets of the dashboard
  ::execv(program, arguments);
  ::_exit(127);
}

class File {
 public:
  explicit File(const std::filesystem::path& path)
      : descriptor_{::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)} {
    if (descriptor_ < 0) throw std::runtime_error(path.string() + ": " + std::strerror(errno));
  }
  ~File() { ::close(descriptor_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

BoundedProcess::BoundedProcess(const std::filesystem::path& program,
                               const std::vector<std::string>& arguments, const std::filesystem::path& output,
                               const std::filesystem::path& errors, const Bounds& bounds)
    : bounds_{bounds}, started_ns_{runtime::monotonic_ns()} {
  const File out{output}, error{errors};
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const auto processors = std::max(1U, std::thread::hardware_concurrency());
  const auto parent = ::getpid();
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("cannot start " + program.string() + ": " + std::strerror(errno));
  if (pid_ == 0)
    become(program.c_str(), argv.data(), out.descriptor(), error.descriptor(), bounds, processors, parent);
}

BoundedProcess::~BoundedProcess() {
  if (pid_ <= 0) return;
  kill();
  ::waitpid(pid_, nullptr, 0);
}

void BoundedProcess::kill() {
  ::kill(-pid_, SIGKILL);  // kills the process group of the child, which may not exist yet
  ::kill(pid_, SIGKILL);
}

std::optional<BoundedProcess::End> BoundedProcess::poll() {
  const bool late = runtime::monotonic_ns() - started_ns_ > std::chrono::nanoseconds{bounds_.time}.count();
  if (late) kill();
  int status = 0;
  if (pid_ <= 0 || ::waitpid(pid_, &status, late ? 0 : WNOHANG) != pid_) return std::nullopt;
  pid_ = 0;
  if (late) return End{-1, "took longer than " + std::to_string(bounds_.time.count()) + " s"};
  if (WIFEXITED(status)) return End{WEXITSTATUS(status), "exit code " + std::to_string(WEXITSTATUS(status))};
  return End{-1, std::string{"signal "} + ::strsignal(WTERMSIG(status))};
}

}  // namespace crane::dashboard
