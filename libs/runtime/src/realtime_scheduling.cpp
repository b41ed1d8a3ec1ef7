#include "crane/runtime/realtime_scheduling.hpp"

#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

namespace crane::runtime {
namespace {

/// @return 0 or the errno of the first thread whose change the system denies
int schedule_all_threads(int policy, int priority) {
  const sched_param parameters{.sched_priority = priority};
  std::error_code unreadable;
  const std::filesystem::directory_iterator threads{"/proc/self/task", unreadable};
  if (unreadable) return unreadable.value();
  for (const auto& thread : threads) {
    const auto id = static_cast<pid_t>(std::stol(thread.path().filename().string()));
    if (::sched_setscheduler(id, policy, &parameters) != 0 && errno != ESRCH) return errno;
  }
  return 0;
}

}  // namespace

RealtimeScheduling::Answer RealtimeScheduling::enter(int priority) {
  if (priority <= 0) return {};
  entered_ = true;
  return {.memory = ::mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno,
          .scheduling = schedule_all_threads(SCHED_FIFO, priority)};
}

RealtimeScheduling::~RealtimeScheduling() {
  if (!entered_) return;
  schedule_all_threads(SCHED_OTHER, 0);
  ::munlockall();
}

}  // namespace crane::runtime
