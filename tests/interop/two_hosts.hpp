#pragma once
/// Two hosts on this computer: network namespaces joined by a veth pair. Needs root.
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <system_error>
#include <vector>

#include "../recording/temporary_directory.hpp"
#include "stack/child_processes.hpp"

namespace crane::hosts {

struct Answer {
  int exit_code = -1;
  std::string output;  ///< standard output only: messages of a DDS library can come at any time
  std::string errors;  ///< standard error
};

inline Answer run(const std::string& command) {
  Answer answer;
  const recording::TemporaryDirectory directory;
  const auto errors = directory / "errors";
  FILE* pipe = ::popen((command + " 2>" + errors.string()).c_str(), "r");
  if (pipe == nullptr) return answer;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    answer.output.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status)) answer.exit_code = WEXITSTATUS(status);
  answer.errors = recording::contents_of(errors);
  return answer;
}

/// Two private hosts, which exist while this object exists.
class TwoHosts {
 public:
  TwoHosts()
      : near_{"crane_near_" + std::to_string(::getpid())}, far_{"crane_far_" + std::to_string(::getpid())} {
    const std::string id = std::to_string(::getpid());
    ok_ = run("ip netns add " + near_).exit_code == 0 && run("ip netns add " + far_).exit_code == 0 &&
          run("ip link add cn" + id + " netns " + near_ + " type veth peer name cf" + id + " netns " + far_)
                  .exit_code == 0 &&
          run("ip -n " + near_ + " addr add " + kNear + "/24 dev cn" + id).exit_code == 0 &&
          run("ip -n " + far_ + " addr add " + kFar + "/24 dev cf" + id).exit_code == 0 &&
          run("ip -n " + near_ + " link set cn" + id + " up").exit_code == 0 &&
          run("ip -n " + far_ + " link set cf" + id + " up").exit_code == 0 &&
          run("ip -n " + near_ + " link set lo up").exit_code == 0 &&
          run("ip -n " + far_ + " link set lo up").exit_code == 0 && has_carrier(near_, "cn" + id) &&
          has_carrier(far_, "cf" + id);
  }
  ~TwoHosts() {
    run("ip netns del " + near_);
    run("ip netns del " + far_);
  }
  TwoHosts(const TwoHosts&) = delete;
  TwoHosts& operator=(const TwoHosts&) = delete;

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] const std::string& near() const { return near_; }
  [[nodiscard]] const std::string& far() const { return far_; }
  [[nodiscard]] Answer on_far(const std::string& arguments) const {
    return run("ip netns exec " + far_ + " " + (stack::program_directory() / "crane").string() + " " +
               arguments);
  }
  [[nodiscard]] Answer on_near(const std::string& arguments) const {
    return run("ip netns exec " + near_ + " " + (stack::program_directory() / "crane").string() + " " +
               arguments);
  }
  /// Device of the pair in each host.
  [[nodiscard]] std::string near_device() const { return "cn" + std::to_string(::getpid()); }
  [[nodiscard]] std::string far_device() const { return "cf" + std::to_string(::getpid()); }
  /// Adds an address to the far host, as if one more computer were on the network.
  void add_far(const std::string& address) const {
    run("ip -n " + far_ + " addr add " + address + "/24 dev " + far_device());
  }
  /// Removes the link, as when a USB network adapter is pulled out.
  void remove_link() const { run("ip -n " + near_ + " link del " + near_device()); }
  void unplug_far() const { run("ip -n " + far_ + " link set cf" + std::to_string(::getpid()) + " down"); }
  static constexpr const char* kNear = "10.77.0.1";
  static constexpr const char* kFar = "10.77.0.2";

 private:
  /// Waits for the carrier: the kernel reports it up to seconds after both ends are up. Between two checks
  /// the function waits for a message of the kernel, because each check delays the report.
  static bool has_carrier(const std::string& host, const std::string& device) {
    for (int i = 0; i < 30; ++i) {
      const std::string on_host = "ip -n " + host + " ";
      if (run(on_host + "link show " + device).output.find("state UP") != std::string::npos) return true;
      run("timeout 1 " + on_host + "monitor link dev " + device + " | grep -q -m 1 'state UP'");
    }
    return false;
  }

  std::string near_, far_;
  bool ok_ = false;
};

/// While this object exists, the calling thread is on another host; sockets and threads that it creates
/// remain there.
class OnHost {
 public:
  explicit OnHost(const std::string& host) : own_{opened("/proc/thread-self/ns/net")} {
    const int other = opened("/run/netns/" + host);
    const int result = ::setns(other, CLONE_NEWNET);
    ::close(other);
    if (result != 0) throw std::system_error{errno, std::generic_category(), "setns"};
  }
  ~OnHost() {
    ::setns(own_, CLONE_NEWNET);
    ::close(own_);
  }
  OnHost(const OnHost&) = delete;
  OnHost& operator=(const OnHost&) = delete;

 private:
  static int opened(const std::string& path) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) throw std::system_error{errno, std::generic_category(), path};
    return file;
  }
  int own_;
};

/// A program that runs on one of the hosts. Ctrl-C ends it.
class RunningProgram {
 public:
  RunningProgram(const std::string& host, const std::string& program,
                 const std::vector<std::string>& command) {
    std::vector<std::string> arguments{"ip", "netns", "exec", host, program};
    arguments.insert(arguments.end(), command.begin(), command.end());
    std::vector<char*> argv;
    for (auto& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    ::execvp("ip", argv.data());
    ::_exit(127);
  }
  ~RunningProgram() { (void)interrupted(std::chrono::minutes{1}); }
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Interrupts the program as Ctrl-C does, and kills it after `limit`. @return true when it ended by itself
  bool interrupted(std::chrono::milliseconds limit) {
    if (pid_ == 0) return true;
    const int handle = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
    ::kill(pid_, SIGINT);
    pollfd end{.fd = handle, .events = POLLIN, .revents = 0};
    const bool ended = ::poll(&end, 1, static_cast<int>(limit.count())) == 1;
    if (!ended) ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
    ::close(handle);
    pid_ = 0;
    return ended;
  }

 private:
  pid_t pid_ = 0;
};

/// A running `crane` command.
class Running : public RunningProgram {
 public:
  Running(const std::string& host, const std::vector<std::string>& command)
      : RunningProgram{host, (stack::program_directory() / "crane").string(), command} {}
};

}  // namespace crane::hosts
