#include "crane/workers/process_pool.hpp"

#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace crane::workers {
namespace {

using Length = std::uint32_t;  ///< of a record, before its bytes

void write_all(int descriptor, const char* bytes, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, bytes, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(1);
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
}

struct Running {
  std::size_t task;
  pid_t process;
  int descriptor;
  std::string bytes{};  ///< received, without complete records
};

class Pool {
 public:
  explicit Pool(const Tasks& tasks) : tasks_{tasks} {}
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;
  /// Ends the tasks that still run after an exception or a cancellation.
  ~Pool() {
    for (const Running& one : running_) ::kill(one.process, SIGKILL);
    for (const Running& one : running_) {
      ::close(one.descriptor);
      wait_for(one.process);
    }
  }

  void run() {
    const std::size_t most = std::max<std::size_t>(1, tasks_.at_a_time);
    while (next_ < tasks_.count || !running_.empty()) {
      while (next_ < tasks_.count && running_.size() < most) start(next_++);
      listen();
      if (tasks_.cancelled && tasks_.cancelled()) return;
    }
  }

 private:
  void start(std::size_t task) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process < 0) {
      const int error = errno;
      ::close(ends[0]);
      ::close(ends[1]);
      throw std::system_error(error, std::generic_category(), "fork");
    }
    if (process == 0) be_the_task(task, parent, ends[1]);
    ::close(ends[1]);
    running_.push_back({task, process, ends[0]});
  }

  [[noreturn]] void be_the_task(std::size_t task, pid_t parent, int descriptor) const {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent has ended before this process requested the signal
    int code = 0;
    try {
      tasks_.work(task, Outbox{descriptor});
    } catch (...) {
      code = 1;
    }
    ::_exit(code);
  }

  void listen() {
    std::vector<pollfd> sources;
    for (const Running& one : running_) sources.push_back({one.descriptor, POLLIN, 0});
    if (::poll(sources.data(), sources.size(), -1) < 0) {
      if (errno == EINTR) return;
      throw std::system_error(errno, std::generic_category(), "poll");
    }
    for (std::size_t i = sources.size(); i-- > 0;)
      if (sources[i].revents != 0) receive(i);
  }

  void receive(std::size_t index) {
    constexpr std::size_t kBlock = 65536;
    Running& one = running_[index];
    std::array<char, kBlock> block;
    const ssize_t size = ::read(one.descriptor, block.data(), block.size());
    if (size < 0) return;
    if (size == 0) return finish(index);
    one.bytes.append(block.data(), static_cast<std::size_t>(size));
    Length length = 0;
    std::size_t begin = 0;
    for (; one.bytes.size() - begin >= sizeof length; begin += sizeof length + length) {
      std::memcpy(&length, one.bytes.data() + begin, sizeof length);
      if (one.bytes.size() - begin - sizeof length < length) break;
      tasks_.take(one.task, one.bytes.substr(begin + sizeof length, length));
    }
    one.bytes.erase(0, begin);
  }

  void finish(std::size_t index) {
    const Running one = std::move(running_[index]);
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(index));
    ::close(one.descriptor);
    const int status = wait_for(one.process);
    std::string failure;
    if (WIFSIGNALED(status)) failure = "signal " + std::to_string(WTERMSIG(status));
    if (WIFEXITED(status) && WEXITSTATUS(status) != 0)
      failure = "exit code " + std::to_string(WEXITSTATUS(status));
    if (tasks_.ended) tasks_.ended(one.task, failure);
  }

  static int wait_for(pid_t process) {
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return status;
  }

  const Tasks& tasks_;
  std::vector<Running> running_;
  std::size_t next_ = 0;
};

}  // namespace

void Outbox::send(std::string_view record) const {
  const auto length = static_cast<Length>(record.size());
  write_all(descriptor_, reinterpret_cast<const char*>(&length), sizeof length);
  write_all(descriptor_, record.data(), record.size());
}

void run(const Tasks& tasks) { Pool{tasks}.run(); }

void require_success(std::size_t task, const std::string& failure) {
  if (!failure.empty())
    throw std::runtime_error("the process of task " + std::to_string(task) + " ended with " + failure);
}

unsigned processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
}

}  // namespace crane::workers
