#pragma once
/// A link between two hosts (network namespaces) that loses and delays frames at random: two TAP devices and
/// a thread that forwards. Needs root and /dev/net/tun.
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <random>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "two_hosts.hpp"

namespace crane::hosts {

class LossyLink {
 public:
  struct Properties {
    double lost_share = 0;  ///< of the frames of each direction; address resolution (ARP) loses none
    std::chrono::milliseconds delay{0};
    std::uint32_t seed = 1;
  };
  static constexpr const char* kNear = "10.78.0.1";
  static constexpr const char* kFar = "10.78.0.2";

  /// @throws std::system_error
  LossyLink(const TwoHosts& hosts, const Properties& properties)
      : properties_{properties}, ends_{tap(hosts.near()), tap(hosts.far())} {
    up(hosts.near(), kNear);
    up(hosts.far(), kFar);
    thread_ = std::thread{[this] { forward(); }};
  }
  ~LossyLink() {
    ::eventfd_write(stop_, 1);
    thread_.join();
    for (const int file : {ends_[0].file, ends_[1].file, stop_}) ::close(file);
  }
  LossyLink(const LossyLink&) = delete;
  LossyLink& operator=(const LossyLink&) = delete;

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Frame {
    Clock::time_point due;
    std::vector<char> bytes;
  };
  struct End {
    int file;
    std::deque<Frame> arriving;  ///< at this end, in the order of their times
  };
  static constexpr const char* kDevice = "lossy";

  static int checked(int result, const char* what) {
    if (result < 0) throw std::system_error{errno, std::generic_category(), what};
    return result;
  }
  static End tap(const std::string& host) {
    int file = -1;
    std::exception_ptr failure;
    std::thread{[&] {  // a separate thread, because setns() moves the calling thread
      try {
        const int space = checked(::open(("/run/netns/" + host).c_str(), O_RDONLY | O_CLOEXEC), "netns");
        const int moved = ::setns(space, CLONE_NEWNET);
        ::close(space);
        checked(moved, "setns");
        file = checked(::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC), "/dev/net/tun");
        ifreq request{};
        request.ifr_flags = IFF_TAP | IFF_NO_PI;
        std::strncpy(request.ifr_name, kDevice, IFNAMSIZ - 1);
        checked(::ioctl(file, TUNSETIFF, &request), "TUNSETIFF");
      } catch (...) {
        failure = std::current_exception();
      }
    }}
        .join();
    if (failure) std::rethrow_exception(failure);
    return {.file = file, .arriving = {}};
  }
  static void up(const std::string& host, const char* address) {
    const std::string ip = "ip -n " + host + " ";
    for (const auto& command :
         {ip + "addr add " + address + "/24 dev " + kDevice, ip + "link set " + std::string{kDevice} + " up"})
      if (const auto answer = run(command); answer.exit_code != 0)
        throw std::system_error{EINVAL, std::generic_category(), command + ": " + answer.errors};
  }

  void forward() {
    std::mt19937 random{properties_.seed};
    for (bool goes_on = true; goes_on;) {
      auto next = Clock::time_point::max();
      for (auto& end : ends_) {
        deliver(end);
        if (!end.arriving.empty()) next = std::min(next, end.arriving.front().due);
      }
      std::array<pollfd, 3> polled{
          {{ends_[0].file, POLLIN, 0}, {ends_[1].file, POLLIN, 0}, {stop_, POLLIN, 0}}};
      const auto left = std::max(Clock::duration{}, next - Clock::now());
      const timespec wait{.tv_sec = 0, .tv_nsec = std::min<long>(left.count(), 999'999'999)};
      ::ppoll(polled.data(), polled.size(), next == Clock::time_point::max() ? nullptr : &wait, nullptr);
      goes_on = polled[2].revents == 0;
      take(ends_[0], ends_[1], random);
      take(ends_[1], ends_[0], random);
    }
  }
  static void deliver(End& end) {
    for (; !end.arriving.empty() && end.arriving.front().due <= Clock::now(); end.arriving.pop_front()) {
      const auto& bytes = end.arriving.front().bytes;
      // A full queue of the device is a further loss.
      [[maybe_unused]] const auto written = ::write(end.file, bytes.data(), bytes.size());
    }
  }
  void take(End& from, End& to, std::mt19937& random) {
    std::array<char, 65536> bytes{};
    for (ssize_t size = 0; (size = ::read(from.file, bytes.data(), bytes.size())) > 0;) {
      constexpr std::size_t kHeader = 14;
      const bool resolution = size >= static_cast<ssize_t>(kHeader) && bytes[12] == 0x08 && bytes[13] == 0x06;
      ++frames_;
      if (!resolution && std::bernoulli_distribution{properties_.lost_share}(random)) {
        ++lost_;
        continue;
      }
      to.arriving.push_back({Clock::now() + properties_.delay, {bytes.data(), bytes.data() + size}});
    }
  }

  Properties properties_;
  std::array<End, 2> ends_;
  std::atomic<std::uint64_t> frames_{0}, lost_{0};
  int stop_ = checked(::eventfd(0, EFD_CLOEXEC), "eventfd");
  std::thread thread_;
};

}  // namespace crane::hosts
