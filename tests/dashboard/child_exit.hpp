#pragma once
/// Waits for the end of a process without polling.
#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

namespace crane::dashboard {

/// Waits until a process ends, at most `longest`. A zombie has ended. @return true when the process has ended
inline bool ends_within(pid_t pid, std::chrono::milliseconds longest) {
  const auto descriptor = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
  if (descriptor < 0) return true;  // no such process
  pollfd event{descriptor, POLLIN, 0};
  const bool ended = ::poll(&event, 1, static_cast<int>(longest.count())) == 1;
  ::close(descriptor);
  return ended;
}

/// Waits until a child of this process ends, without removing its exit status.
inline void await_end_of_a_child() {
  siginfo_t info{};
  ::waitid(P_ALL, 0, &info, WEXITED | WNOWAIT);
}

}  // namespace crane::dashboard
