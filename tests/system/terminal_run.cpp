#include "terminal_run.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utmp.h>

#include <array>
#include <csignal>
#include <stdexcept>

#include "program_run.hpp"

namespace crane::system_test {

using std::chrono::steady_clock;

TerminalRun::TerminalRun(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                         int columns, int rows) {
  const auto path = program.string();
  std::vector<char*> argv{const_cast<char*>(path.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  // This process keeps the terminal of the program open, so that its settings remain readable after the end
  // of the program.
  if (::openpty(&terminal_, &other_end_, nullptr, nullptr, nullptr) != 0)
    throw std::runtime_error("cannot open a terminal");
  resize(columns, rows);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("cannot start " + path);
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    ::close(terminal_);
    ::login_tty(other_end_);
    ::execv(path.c_str(), argv.data());
    ::_exit(127);
  }
}

TerminalRun::~TerminalRun() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  ::close(terminal_);
  ::close(other_end_);
}

void TerminalRun::send(int signal) const {
  if (pid_ > 0) ::kill(pid_, signal);
}

void TerminalRun::type(const std::string& keys) const {
  if (::write(terminal_, keys.data(), keys.size()) != static_cast<ssize_t>(keys.size()))
    throw std::runtime_error("cannot type");
}

void TerminalRun::resize(int columns, int rows) const {
  winsize size{};
  size.ws_col = static_cast<unsigned short>(columns);
  size.ws_row = static_cast<unsigned short>(rows);
  ::ioctl(terminal_, TIOCSWINSZ, &size);
}

termios TerminalRun::settings() const {
  termios now{};
  ::tcgetattr(other_end_, &now);
  return now;
}

bool TerminalRun::read_some(steady_clock::time_point give_up) {
  pollfd wait{terminal_, POLLIN, 0};
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(give_up - steady_clock::now());
  if (::poll(&wait, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0))) <= 0) return false;
  std::array<char, 4096> part{};
  const auto n = ::read(terminal_, part.data(), part.size());
  if (n > 0) output_.append(part.data(), static_cast<std::size_t>(n));
  return n > 0;
}

bool TerminalRun::wait_for(const std::string& text, std::chrono::milliseconds patience) {
  const auto give_up = steady_clock::now() + patience;
  while (output_.find(text) == std::string::npos)
    if (!read_some(give_up)) return false;
  return true;
}

std::optional<int> TerminalRun::wait(std::chrono::milliseconds patience) {
  if (!wait_for_end({pid_}, patience)) return std::nullopt;
  while (read_some(steady_clock::now())) {
  }
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = 0;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace crane::system_test
