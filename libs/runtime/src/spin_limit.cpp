#include "crane/runtime/spin_limit.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <system_error>

namespace crane::runtime {

void limit_spin_time() {
  const auto spin_us = static_cast<rlim_t>(std::chrono::microseconds{kLongestSpin}.count());
  const rlimit limit{.rlim_cur = spin_us, .rlim_max = 2 * spin_us};
  if (::setrlimit(RLIMIT_RTTIME, &limit) != 0)
    throw std::system_error{errno, std::generic_category(), "setrlimit(RLIMIT_RTTIME)"};
}

}  // namespace crane::runtime
