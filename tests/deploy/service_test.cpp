/// `crane up` under a service manager, and the units.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "../recording/temporary_directory.hpp"
#include "../system/program_run.hpp"
#include "stack/child_processes.hpp"

namespace crane::stack {
namespace {

using namespace std::chrono_literals;

/// The socket of a service manager.
class Manager {
 public:
  explicit Manager(const std::filesystem::path& path)
      : descriptor_{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
    sockaddr_un own{};
    own.sun_family = AF_UNIX;
    path.string().copy(own.sun_path, sizeof own.sun_path - 1);
    ::bind(descriptor_, reinterpret_cast<const sockaddr*>(&own), sizeof own);
    const timeval patience{.tv_sec = 20, .tv_usec = 0};
    ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  ~Manager() { ::close(descriptor_); }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;
  std::string heard() {
    std::array<char, 256> text{};
    const auto size = ::recv(descriptor_, text.data(), text.size(), 0);
    return size < 0 ? "" : std::string(text.data(), static_cast<std::size_t>(size));
  }

 private:
  int descriptor_;
};

TEST(Service, IsReadyWhenEveryProcessIsAndFeedsTheWatchdog) {
  const recording::TemporaryDirectory directory;
  Manager manager{directory / "notify"};
  ::setenv("NOTIFY_SOCKET", (directory / "notify").c_str(), 1);
  ::setenv("WATCHDOG_USEC", "600000", 1);
  system_test::ProgramRun up{program_directory() / "crane",
                             {"up", "--priority", "0", "--no-black-box", "--domain", "89", "--crane",
                              "service_test_" + std::to_string(::getpid())}};
  ::unsetenv("NOTIFY_SOCKET");
  ::unsetenv("WATCHDOG_USEC");
  EXPECT_EQ(manager.heard(), "READY=1");
  EXPECT_TRUE(up.wait_for("is up with", 1s)) << "ready is not told before";
  for (int i = 0; i < 3; ++i) EXPECT_EQ(manager.heard(), "WATCHDOG=1");
  up.send(SIGTERM);
  std::string last;
  while ((last = manager.heard()) == "WATCHDOG=1") {
  }
  EXPECT_EQ(last, "STOPPING=1");
}

TEST(Units, AreRightForSystemd) {
  const recording::TemporaryDirectory root;  // root directory with the program that the units start
  std::filesystem::create_directories(root / "usr/bin");
  std::filesystem::create_directories(root / "etc/systemd/system");
  std::filesystem::create_directories(root / "usr/lib/systemd/system");
  std::filesystem::create_symlink("usr/lib", root / "lib");
  std::filesystem::copy("/usr/lib/systemd/system", root / "usr/lib/systemd/system",
                        std::filesystem::copy_options::recursive |
                            std::filesystem::copy_options::copy_symlinks |
                            std::filesystem::copy_options::overwrite_existing);
  std::filesystem::copy_file(program_directory() / "crane", root / "usr/bin/crane");
  std::filesystem::copy(CRANE_UNITS, root / "etc/systemd/system");
  const auto verified = system_test::run_program(
      "/usr/bin/systemd-analyze",
      {"verify", "--man=no", "--root=" + (root / "").string(), "crane.service", "crane-dashboard.service"});
  EXPECT_EQ(verified.exit_code, 0);
  EXPECT_THAT(verified.errors, testing::Not(testing::HasSubstr("crane"))) << "no warning of these units";
}

}  // namespace
}  // namespace crane::stack
