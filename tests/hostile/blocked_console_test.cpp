/// `crane up` cannot write: nobody reads its output, or the messages to the service manager. Forbidden:
/// Ctrl-C or `systemctl stop` does not stop the crane.
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <fstream>

#include "../recording/temporary_directory.hpp"
#include "../system/program_run.hpp"
#include "../system/running_stack.hpp"
#include "stack/data_files.hpp"

namespace crane::hostile {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kDomain = 84;

/// A pipe without a reader of its data.
class UnreadPipe {
 public:
  UnreadPipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0)
      throw std::system_error{errno, std::generic_category(), "pipe2"};
    ::fcntl(ends_[1], F_SETPIPE_SZ, 4096);
  }
  ~UnreadPipe() {
    for (const int end : ends_) ::close(end);
  }
  UnreadPipe(const UnreadPipe&) = delete;
  UnreadPipe& operator=(const UnreadPipe&) = delete;
  [[nodiscard]] int writer() const { return ends_[1]; }
  void fill() const {
    ::fcntl(ends_[1], F_SETFL, O_NONBLOCK);
    while (::write(ends_[1], "x", 1) == 1) continue;
    ::fcntl(ends_[1], F_SETFL, 0);
  }

 private:
  std::array<int, 2> ends_{};
};

/// The socket of a service manager that reads nothing.
class UnreadSocket {
 public:
  explicit UnreadSocket(const std::filesystem::path& path)
      : socket_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    sockaddr_un own{};
    own.sun_family = AF_UNIX;
    path.string().copy(own.sun_path, sizeof own.sun_path - 1);
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0)
      throw std::system_error{errno, std::generic_category(), path};
  }
  ~UnreadSocket() { ::close(socket_); }
  UnreadSocket(const UnreadSocket&) = delete;
  UnreadSocket& operator=(const UnreadSocket&) = delete;

 private:
  int socket_;
};

class BlockedConsole : public testing::Test {
 protected:
  static constexpr auto kStop = 3s;  ///< from the signal to the end of the plant

  ~BlockedConsole() override {
    for (const auto pid : system_test::processes_with(bus_options_.crane)) ::kill(pid, SIGKILL);
    if (up_ > 0) ::kill(up_, SIGKILL);
    if (up_ > 0) ::waitpid(up_, nullptr, 0);
  }
  /// Starts `crane up`, and arms the crane.
  void arm(int output, int errors) {
    const auto crane = (stack::program_directory() / "crane").string();
    const auto recording = (directory_ / "run.mcap").string(), domain = std::to_string(kDomain);
    up_ = ::fork();
    if (up_ == 0) {
      ::dup2(output, STDOUT_FILENO);
      ::dup2(errors, STDERR_FILENO);
      ::execl(crane.c_str(), crane.c_str(), "up", "--no-black-box", "--record", recording.c_str(), "--domain",
              domain.c_str(), "--crane", bus_options_.crane.c_str(), nullptr);
      ::_exit(127);
    }
    bus_.emplace(runtime::bus_options(bus_options_, "operator", crane_SOURCE_OPERATOR, 0));
    auto statuses = bus_->subscriber(topics::supervisor);
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (!statuses.take() && std::chrono::steady_clock::now() < end) bus_->wait(20ms);
    session_.emplace(*bus_, [] {});
    session_->arm();
  }
  [[nodiscard]] pid_t child(const std::string& text) const {
    for (const auto pid : system_test::processes_with(bus_options_.crane)) {
      std::ifstream file{"/proc/" + std::to_string(pid) + "/cmdline"};
      const std::string line{std::istreambuf_iterator<char>{file}, {}};
      if (line.find(text) != std::string::npos && pid != up_) return pid;
    }
    return 0;
  }
  /// Waits until the main thread of `crane up` waits in this function of the kernel.
  [[nodiscard]] bool waits_in(const std::string& function) {
    const auto end = std::chrono::steady_clock::now() + 5s;
    while (std::chrono::steady_clock::now() < end) {
      std::string place;
      std::getline(std::ifstream{"/proc/" + std::to_string(up_) + "/wchan"}, place);
      if (place.find(function) != std::string::npos) return true;
      session_->wait(20ms);
    }
    return false;
  }
  void expect_stop_by(int signal) {
    const auto plant = child("crane_plant");
    ASSERT_GT(plant, 0);
    ASSERT_EQ(session_->status()->state, crane_STATE_HOLD);
    ::kill(up_, signal);
    EXPECT_TRUE(system_test::wait_for_end({plant}, kStop))
        << "the plant still runs: the crane is not stopped";
  }

  recording::TemporaryDirectory directory_;
  UnreadPipe unread_;
  runtime::BusOptions bus_options_ = system_test::launch_options(kDomain, "virginia_tech_tower").bus;
  pid_t up_ = 0;
  std::optional<bus::Bus> bus_;
  std::optional<experiments::RealtimeSession> session_;
};

TEST_F(BlockedConsole, WithAMessageThatNobodyReadsEndsTheStackAtCtrlC) {
  arm(STDOUT_FILENO, unread_.writer());
  unread_.fill();
  ASSERT_EQ(::kill(child("run.mcap"), SIGKILL), 0);  // `crane up` reports the end of the recorder
  ASSERT_TRUE(waits_in("pipe_write")) << "the console is not blocked: this test proves nothing";
  expect_stop_by(SIGINT);
}

TEST_F(BlockedConsole, FromTheStartOnEndsTheStackAtSigterm) {
  unread_.fill();
  arm(unread_.writer(), STDERR_FILENO);
  ASSERT_TRUE(waits_in("pipe_write")) << "the console is not blocked: this test proves nothing";
  expect_stop_by(SIGTERM);
}

TEST_F(BlockedConsole, OfAServiceManagerThatReadsNothingEndsTheStackAtSigterm) {
  const auto path = directory_ / "manager";
  const UnreadSocket manager{path};
  ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
  ::setenv("WATCHDOG_USEC", "30000", 1);  // one message per 50 ms; the socket holds about ten
  arm(STDOUT_FILENO, STDERR_FILENO);
  ::unsetenv("NOTIFY_SOCKET");
  ::unsetenv("WATCHDOG_USEC");
  session_->wait(1s);
  expect_stop_by(SIGTERM);
}

}  // namespace
}  // namespace crane::hostile
