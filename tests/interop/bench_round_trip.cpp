// Round trip of one crane/state through a thread with its own bus, per vendor, compared with a pair of UDP
// sockets on the same interface. Prints median and 99th percentile in microseconds.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <functional>
#include <thread>

#include "crane/bus/bus.hpp"

namespace {

using namespace crane;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int kRoundTrips = 2000;

void report(const char* name, const std::function<bool()>& round_trip) {
  std::vector<double> times_us;
  int lost = 0;
  auto next = Clock::now();
  for (int i = 0; i < kRoundTrips; ++i) {
    next += 1ms;
    std::this_thread::sleep_until(next);
    const auto begin = Clock::now();
    if (round_trip())
      times_us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    else
      ++lost;
  }
  if (times_us.empty()) return;
  std::sort(times_us.begin(), times_us.end());
  std::printf("%-20s p50 %6.0f us   p99 %6.0f us   lost %d\n", name, times_us[times_us.size() / 2],
              times_us[times_us.size() * 99 / 100], lost);
}

void bus_round_trip(bus::Vendor vendor) {
  const auto network = bus::make_memory_network();
  const bus::Options options{.vendor = vendor, .domain = 48, .network = network};
  std::atomic<bool> stop{false};
  std::thread echo{[&] {
    bus::Bus bus{options};
    auto in = bus.subscriber(topics::tracking);
    auto out = bus.publisher(topics::anti_swing);
    while (!stop)
      if (bus.wait(50ms))
        while (auto sample = in.take())
          if (!out.publish(*sample)) std::abort();
  }};
  {
    bus::Bus bus{options};
    auto out = bus.publisher(topics::tracking);
    auto in = bus.subscriber(topics::anti_swing);
    const auto end = Clock::now() + 10s;
    while ((out.matched() == 0 || in.matched() == 0) && Clock::now() < end) bus.wait(5ms);
    std::this_thread::sleep_for(1s);  // the echoing side has also matched
    msg::Contribution sample{};
    report(std::string{to_string(vendor)}.c_str(), [&] {
      ++sample.header.tick;
      if (!out.publish(sample)) std::abort();
      const auto late = Clock::now() + 100ms;
      while (Clock::now() < late) {
        bus.wait(10ms);
        while (const auto back = in.take())
          if (back->header.tick == sample.header.tick) return true;
      }
      return false;
    });
  }
  stop = true;
  echo.join();
}

int bound_socket(sockaddr_in& address) {
  const int handle = socket(AF_INET, SOCK_DGRAM, 0);
  address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  (void)bind(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  socklen_t length = sizeof address;
  getsockname(handle, reinterpret_cast<sockaddr*>(&address), &length);
  return handle;
}

void udp_round_trip() {
  sockaddr_in here{};
  sockaddr_in there{};
  const int near_end = bound_socket(here);
  const int far_end = bound_socket(there);
  (void)connect(near_end, reinterpret_cast<const sockaddr*>(&there), sizeof there);
  (void)connect(far_end, reinterpret_cast<const sockaddr*>(&here), sizeof here);
  std::thread echo{[far_end] {
    std::array<char, 256> buffer{};
    for (ssize_t n = 0; (n = recv(far_end, buffer.data(), buffer.size(), 0)) > 1;)
      (void)send(far_end, buffer.data(), static_cast<std::size_t>(n), 0);
  }};
  std::array<char, sizeof(msg::Contribution)> buffer{};
  report("UDP sockets", [&] {
    return send(near_end, buffer.data(), buffer.size(), 0) > 0 &&
           recv(near_end, buffer.data(), buffer.size(), 0) > 0;
  });
  (void)send(near_end, buffer.data(), 1, 0);  // a single byte ends the echo
  echo.join();
  close(near_end);
  close(far_end);
}

}  // namespace

int main() {
  std::printf("round trip of %zu bytes at 1 kHz\n", sizeof(msg::Contribution));
  udp_round_trip();
  for (const auto vendor : {bus::Vendor::memory, bus::Vendor::cyclone, bus::Vendor::fastdds})
    bus_round_trip(vendor);
  return 0;
}
