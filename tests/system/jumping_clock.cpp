/// Preloaded library that adds an offset to the wall clock of a process, as a correction of the clock does.
/// CLOCK_MONOTONIC is unchanged. CRANE_CLOCK_FILE names a file with the offset (int64, ns).
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <ctime>

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

std::int64_t offset_ns() {
  static const volatile std::int64_t* const mapped = [] {
    const char* path = std::getenv("CRANE_CLOCK_FILE");
    const int file = path == nullptr ? -1 : ::open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return static_cast<const std::int64_t*>(nullptr);
    void* place = ::mmap(nullptr, sizeof(std::int64_t), PROT_READ, MAP_SHARED, file, 0);
    ::close(file);
    return place == MAP_FAILED ? nullptr : static_cast<const std::int64_t*>(place);
  }();
  return mapped == nullptr ? 0 : *mapped;
}

bool is_wall_clock(clockid_t clock) { return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE; }

timespec wall_time() {
  static auto* const real =
      reinterpret_cast<int (*)(clockid_t, timespec*)>(::dlsym(RTLD_NEXT, "clock_gettime"));
  timespec now{};
  real(CLOCK_REALTIME, &now);
  const std::int64_t jumped_ns = now.tv_sec * kSecond_ns + now.tv_nsec + offset_ns();
  return {.tv_sec = jumped_ns / kSecond_ns, .tv_nsec = jumped_ns % kSecond_ns};
}

timespec after(const timespec& time, std::int64_t duration_ns) {
  const std::int64_t sum_ns = time.tv_sec * kSecond_ns + time.tv_nsec + duration_ns;
  return {.tv_sec = sum_ns / kSecond_ns, .tv_nsec = sum_ns % kSecond_ns};
}

std::int64_t difference_ns(const timespec& later, const timespec& earlier) {
  return (later.tv_sec - earlier.tv_sec) * kSecond_ns + later.tv_nsec - earlier.tv_nsec;
}

/// A time since 1970 is larger than the time since the start of any computer.
bool is_wall_time(const timespec& time) { return time.tv_sec > 1'000'000'000; }

}  // namespace

extern "C" {

/// A wait until a wall time lasts longer or shorter when the clock jumps.
int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  constexpr std::int64_t kSlice_ns = 10'000'000;
  if (!is_wall_time(*until)) return ::pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, until);
  while (true) {
    const auto left_ns = std::max<std::int64_t>(difference_ns(*until, wall_time()), 0);
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    const auto end = after(now, std::min(left_ns, kSlice_ns));
    const int result = ::pthread_cond_clockwait(condition, mutex, CLOCK_MONOTONIC, &end);
    if (result != ETIMEDOUT || left_ns <= kSlice_ns) return result;
  }
}

int clock_gettime(clockid_t clock, timespec* now) {
  static auto* const real =
      reinterpret_cast<int (*)(clockid_t, timespec*)>(::dlsym(RTLD_NEXT, "clock_gettime"));
  if (!is_wall_clock(clock)) return real(clock, now);
  *now = wall_time();
  return 0;
}

int gettimeofday(timeval* now, void* /*zone*/) {
  const auto time = wall_time();
  *now = {.tv_sec = time.tv_sec, .tv_usec = time.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* now) {
  const auto seconds = wall_time().tv_sec;
  if (now != nullptr) *now = seconds;
  return seconds;
}

}  // extern "C"
