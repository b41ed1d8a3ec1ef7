#include "crane/runtime/memory_limit.hpp"

#include <sys/resource.h>

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

namespace crane::runtime {
namespace {

/// Private writable memory of this process: the quantity that RLIMIT_DATA limits.
std::size_t data_bytes() {
  std::ifstream status{"/proc/self/status"};
  for (std::string key; status >> key;)
    if (std::size_t kb = 0; key == "VmData:" && status >> kb) return kb << 10U;
  throw std::system_error{ENODATA, std::generic_category(), "VmData in /proc/self/status"};
}

}  // namespace

void limit_memory_growth() {
  rlimit limit{};
  const bool known = ::getrlimit(RLIMIT_DATA, &limit) == 0;
  const rlim_t most = data_bytes() + kMostGrowth_bytes;
  if (known && limit.rlim_cur <= most) return;  // the administrator has set a lower limit
  limit.rlim_cur = most;
  if (!known || ::setrlimit(RLIMIT_DATA, &limit) != 0)
    throw std::system_error{errno, std::generic_category(), "setrlimit(RLIMIT_DATA)"};
}

}  // namespace crane::runtime
