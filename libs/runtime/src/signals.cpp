#include "crane/runtime/signals.hpp"

#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <system_error>

namespace crane::runtime {
namespace {

volatile std::sig_atomic_t stop_signal = 0;

void on(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  if (::sigaction(signal, &action, nullptr) != 0)
    throw std::system_error{errno, std::generic_category(), "sigaction"};
}

}  // namespace

bool stop_requested() { return stop_signal != 0; }

void install_stop_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT})
    on(signal, [](int received) { stop_signal = received; });
  on(SIGPIPE, SIG_IGN);
}

void end_with_parent(int parent) {
  if (::prctl(PR_SET_PDEATHSIG, SIGTERM) != 0)
    throw std::system_error{errno, std::generic_category(), "prctl(PR_SET_PDEATHSIG)"};
  if (::getppid() != parent)
    throw std::runtime_error("the parent process " + std::to_string(parent) + " has ended");
}

}  // namespace crane::runtime
