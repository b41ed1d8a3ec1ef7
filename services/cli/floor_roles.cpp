#include "cli/floor_roles.hpp"

#include <arpa/inet.h>
#include <linux/futex.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "crane/bus/bare.hpp"
#include "crane/bus/cdr.hpp"

namespace crane::cli {
namespace {

/// Topics of a chain: process i writes topic i and reads topic i - 1; process 0 reads the last topic.
const std::array<const topics::Description*, kChainProcesses> kChain{
    &topics::state.description, &topics::tracking.description, &topics::demand.description,
    &topics::command.description};
constexpr std::size_t kLargestSample = sizeof(msg::State);
static_assert(sizeof(msg::Contribution) <= kLargestSample && sizeof(msg::Demand) <= kLargestSample &&
              sizeof(msg::Command) <= kLargestSample);
using ChainSample = std::array<std::uint64_t, (kLargestSample + 7) / 8>;  // begins with Header.tick

/// Calls `measure` once per period. @param measure  returns nothing when the sample was lost
template <class Measure>
void measure_every_period(FloorBoard& board, const FloorOptions& options, double phase, Measure measure) {
  while (board.begin_ns == 0) ::usleep(1000);
  auto due_ns = board.begin_ns + static_cast<std::int64_t>(phase * static_cast<double>(options.period_ns));
  for (std::uint64_t tick = 1; board.count < options.ticks; ++tick) {
    do due_ns += options.period_ns;
    while (due_ns <= runtime::monotonic_ns());
    const timespec at{.tv_sec = due_ns / 1'000'000'000, .tv_nsec = due_ns % 1'000'000'000};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
    const std::optional<std::int64_t> time_ns = measure(tick);
    if (!time_ns) continue;
    board.times_ns()[board.count] = *time_ns;
    ++board.count;
  }
  for (;;) ::pause();
}

sockaddr_in loop_back(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = port;
  return address;
}

/// A process of a chain over DDS.
class DdsLink {
 public:
  DdsLink(const FloorOptions& options, bus::Vendor vendor, std::size_t process)
      : link_{{.vendor = vendor,
               .domain = (options.bus.domain + 1) % 101,  // 0 to 100; discovery must not reach the loop
               .crane = std::string{bus::to_string(vendor)} + "_floor_" + std::to_string(::getppid()),
               .participant = "floor",
               .source = crane_SOURCE_NONE,
               .epoch = 1},
              *kChain[(process + kChain.size() - 1) % kChain.size()],
              *kChain[process]} {}

  void relay(FloorBoard& board) {
    ChainSample sample{};
    for (bool ready = false;;) {
      link_.wait(std::chrono::milliseconds{20});
      while (link_.take(sample.data()))
        if (!link_.write(sample.data())) throw std::runtime_error{"a sample could not be sent"};
      if (ready || !link_.matched()) continue;
      ready = true;
      ++board.ready;
    }
  }
  void measure_round_trips(FloorBoard& board, const FloorOptions& options, double phase) {
    while (!link_.matched()) ::usleep(1000);
    ++board.ready;
    measure_every_period(board, options, phase, [this](std::uint64_t tick) -> std::optional<std::int64_t> {
      ChainSample sample{tick};
      const auto begin_ns = runtime::monotonic_ns();
      const auto end_ns = begin_ns + 100'000'000;  // limits the wait for a lost sample
      if (!link_.write(sample.data())) return std::nullopt;
      while (runtime::monotonic_ns() < end_ns) {
        link_.wait(std::chrono::milliseconds{20});
        while (link_.take(sample.data()))
          if (sample[0] == tick) return runtime::monotonic_ns() - begin_ns;
      }
      return std::nullopt;
    });
  }

 private:
  bus::BareLink link_;
};

void futex(std::atomic<std::uint32_t>& word, int operation, std::uint32_t value) {
  ::syscall(SYS_futex, &word, operation, value, nullptr, nullptr, 0);
}
void wait_for_change(std::atomic<std::uint32_t>& word, std::uint32_t old) {
  while (word == old) futex(word, FUTEX_WAIT_PRIVATE, old);
}

}  // namespace

UdpChain::UdpChain() {
  for (std::size_t i = 0; i < kChain.size(); ++i) {
    auto address = loop_back(0);
    socklen_t size = sizeof address;
    sockets_[i] = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (sockets_[i] < 0 ||
        ::bind(sockets_[i], reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::getsockname(sockets_[i], reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error{std::string{"cannot open a UDP socket on the loop-back: "} +
                               std::strerror(errno)};
    ports_[i] = address.sin_port;
  }
}
UdpChain::~UdpChain() {
  for (const int socket : sockets_)
    if (socket >= 0) ::close(socket);
}

void UdpChain::pass(FloorBoard& board, const FloorOptions& options, std::size_t process) const {
  ++board.ready;
  process == 0 ? measure_round_trips(board, options) : relay(process);
}

void UdpChain::relay(std::size_t process) const {
  ChainSample sample{};
  for (;;)
    if (::recv(sockets_[process], sample.data(), sizeof sample, 0) > 0) send(process, sample.data());
}

void UdpChain::measure_round_trips(FloorBoard& board, const FloorOptions& options) const {
  constexpr timeval kPatience{.tv_sec = 0, .tv_usec = 100'000};  // limits the wait for a lost datagram
  ::setsockopt(sockets_[0], SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
  measure_every_period(board, options, kUdpPhase, [this](std::uint64_t tick) -> std::optional<std::int64_t> {
    ChainSample sample{tick};
    const auto begin_ns = runtime::monotonic_ns();
    send(0, sample.data());
    do
      if (::recv(sockets_[0], sample.data(), sizeof sample, 0) <= 0) return std::nullopt;
    while (sample[0] != tick);
    return runtime::monotonic_ns() - begin_ns;
  });
}

void UdpChain::send(std::size_t process, const void* sample) const {
  const auto bytes = bus::CdrCodec::of(*kChain[process]->descriptor).max_encoded_bytes();
  const auto to = loop_back(ports_[(process + 1) % kChain.size()]);
  (void)::sendto(sockets_[process], sample, std::min(bytes, sizeof(ChainSample)), 0,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

void pass_over_dds(FloorBoard& board, const FloorOptions& options, bus::Vendor vendor, double phase,
                   std::size_t process) {
  DdsLink link{options, vendor, process};
  process == 0 ? link.measure_round_trips(board, options, phase) : link.relay(board);
}

void wake_a_thread(FloorBoard& board, const FloorOptions& options) {
  std::atomic<std::uint32_t> call = 0, answer = 0;
  std::atomic<std::int64_t> woken_ns = 0;
  const std::jthread sleeper{[&] {
    for (std::uint32_t i = 0;; ++i) {
      wait_for_change(call, i);
      woken_ns = runtime::monotonic_ns();
      ++answer;
      futex(answer, FUTEX_WAKE_PRIVATE, 1);
    }
  }};
  ++board.ready;
  measure_every_period(board, options, kFutexPhase, [&](std::uint64_t) -> std::optional<std::int64_t> {
    const auto before = answer.load();
    const auto begin_ns = runtime::monotonic_ns();
    ++call;
    futex(call, FUTEX_WAKE_PRIVATE, 1);
    wait_for_change(answer, before);
    return woken_ns - begin_ns;
  });
}

}  // namespace crane::cli
