#include "crane/runtime/program_start.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>

namespace crane::runtime {

void start_program() noexcept {
  // open() returns the lowest free descriptor: the loop has opened all descriptors below `descriptor`.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(descriptor, F_GETFD) < 0)
      (void)::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  (void)std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace crane::runtime
