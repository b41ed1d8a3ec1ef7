/// crane bench loop: lost ticks and latency of the stack in real time, compared with raw UDP on the loop-back
/// in the same run.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/commands/bench.hpp"
#include "cli/commands/commands.hpp"
#include "cli/number_range.hpp"
#include "experiments/realtime_session.hpp"
#include "stack/data_files.hpp"
#include "stack/launch.hpp"
#include "stack/stack.hpp"

namespace crane::cli {
namespace {

struct BenchOptions {
  stack::LaunchOptions launch;
  std::string rig = stack::kDefaultRig;
  double seconds = 60;
  bool json = false;
};

struct Percentiles {
  double p50_us = 0, p99_us = 0, max_us = 0;
};

Percentiles percentiles(std::vector<std::int64_t> values_ns) {
  if (values_ns.empty()) return {};
  std::sort(values_ns.begin(), values_ns.end());
  const auto at = [&](double share) {
    const auto index = static_cast<std::size_t>(share * static_cast<double>(values_ns.size() - 1));
    return static_cast<double>(values_ns[index]) / 1e3;
  };
  return {at(0.5), at(0.99), at(1)};
}

/// Measures the round trip of a UDP datagram of the size of crane/state to a second thread, 100 times a
/// second. A round trip has two messages; a tick of the loop has four.
class UdpFloor {
 public:
  UdpFloor() : near_{open()}, far_{open()} {
    connect(near_, far_);
    connect(far_, near_);
    echo_ = std::thread{[this] { echo(); }};
    ping_ = std::thread{[this] { ping(); }};
  }
  ~UdpFloor() { finish(); }
  UdpFloor(const UdpFloor&) = delete;
  UdpFloor& operator=(const UdpFloor&) = delete;

  std::vector<std::int64_t> finish() {
    stop_ = true;
    if (ping_.joinable()) ping_.join();
    if (echo_.joinable()) echo_.join();
    if (near_ >= 0) ::close(std::exchange(near_, -1));
    if (far_ >= 0) ::close(std::exchange(far_, -1));
    return std::move(round_trips_ns_);
  }

 private:
  static constexpr std::size_t kBytes = 256;

  static int open() {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (socket < 0 || ::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("cannot open a UDP socket on the loop-back");
    constexpr timeval kPatience{.tv_sec = 0, .tv_usec = 100'000};  // longest wait for a lost datagram
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
    return socket;
  }
  static void connect(int from, int to) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    ::getsockname(to, reinterpret_cast<sockaddr*>(&address), &size);
    ::connect(from, reinterpret_cast<const sockaddr*>(&address), size);
  }
  void echo() const {
    std::array<char, kBytes> data{};
    while (!stop_)
      if (const auto n = ::recv(far_, data.data(), data.size(), 0); n > 0)
        if (::send(far_, data.data(), static_cast<std::size_t>(n), 0) < 0) return;
  }
  void ping() {
    std::array<char, kBytes> data{};
    while (!stop_) {
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
      const auto sent_ns = runtime::monotonic_ns();
      if (::send(near_, data.data(), data.size(), 0) < 0 || ::recv(near_, data.data(), data.size(), 0) < 0)
        continue;
      round_trips_ns_.push_back(runtime::monotonic_ns() - sent_ns);
    }
  }

  int near_, far_;
  std::atomic<bool> stop_ = false;
  std::vector<std::int64_t> round_trips_ns_;
  std::thread echo_, ping_;
};

/// Latencies by an observer of crane/state and crane/command.
struct Observed {
  std::vector<std::int64_t> command_ns;  ///< from the latching of tick k to the arrival of command k
  std::uint64_t ticks = 0, lost_ticks = 0;
};

Observed observe(stack::ChildProcesses& children, const BenchOptions& options) {
  bus::Bus bus{runtime::bus_options(options.launch.bus, "crane_bench", crane_SOURCE_MONITOR, 0)};
  auto commands = bus.subscriber(topics::command);
  Observed observed;
  std::optional<std::uint64_t> last;
  const auto begin_ns = runtime::monotonic_ns() + 500'000'000;  // after start-up and old samples
  const auto end_ns = begin_ns + static_cast<std::int64_t>(options.seconds * 1e9);
  while (runtime::monotonic_ns() < end_ns && !runtime::stop_requested()) {
    bus.wait(std::chrono::milliseconds{50});
    const auto now_ns = runtime::monotonic_ns();
    while (const auto command = commands.take()) {
      if (now_ns < begin_ns) continue;
      if (last && command->header.tick > *last + 1) observed.lost_ticks += command->header.tick - *last - 1;
      if (last && command->header.tick <= *last) continue;
      last = command->header.tick;
      ++observed.ticks;
      observed.command_ns.push_back(now_ns - command->header.sample_time_ns);
    }
    if (const auto ended = children.ended()) throw std::runtime_error(stack::describe(*ended));
  }
  return observed;
}

int bench_loop(BenchOptions options) {
  runtime::install_stop_signals();
  options.launch.rig = stack::find_rig(options.rig).string();
  options.launch.bus.crane = "bench_" + std::to_string(::getpid());
  const auto specs = stack::simulated_stack();
  stack::ChildProcesses children;
  stack::launch(children, specs, options.launch);
  {
    bus::Bus bus{runtime::bus_options(options.launch.bus, "crane_bench", crane_SOURCE_OPERATOR, 0)};
    stack::wait_until_ready(children, specs, bus, std::chrono::seconds{15});
  }
  UdpFloor floor;
  const auto observed = observe(children, options);
  const auto command = percentiles(observed.command_ns);
  const auto udp = percentiles(floor.finish());
  if (options.json) {
    std::cout << nlohmann::ordered_json{{"ticks", observed.ticks},
                                        {"lost_ticks", observed.lost_ticks},
                                        {"state_to_command_us",
                                         {{"p50", command.p50_us},
                                          {"p99", command.p99_us},
                                          {"max", command.max_us}}},
                                        {"udp_round_trip_us",
                                         {{"p50", udp.p50_us}, {"p99", udp.p99_us}, {"max", udp.max_us}}}}
                     .dump(2)
              << '\n';
    return runtime::kExitDone;
  }
  std::cout << "ticks " << observed.ticks << ", lost " << observed.lost_ticks << '\n'
            << "state to command, four hops [us]   p50 " << command.p50_us << "  p99 " << command.p99_us
            << "  max " << command.max_us << '\n'
            << "raw UDP round trip, two hops [us]  p50 " << udp.p50_us << "  p99 " << udp.p99_us << "  max "
            << udp.max_us << '\n';
  return runtime::kExitDone;
}

}  // namespace

void add_bench(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<BenchOptions>();
  auto* command = app.add_subcommand(
      "bench", "Measure times of the stack on this computer, and the score of crane diagnose");
  command->footer("Example: crane bench loop --seconds 60\ndocs/benchmarks.md states the results.");
  command->require_subcommand(1);
  auto* loop =
      command->add_subcommand("loop", "Measure lost ticks and latency in real time, compared with raw UDP");
  loop->add_option("--rig", options->rig, "rig file or name")->capture_default_str();
  loop->add_option("--seconds", options->seconds, "duration in s")
      ->check(number_in(1.0, 86400.0))
      ->capture_default_str();
  loop->add_option("--priority", options->launch.priority, "SCHED_FIFO priority, 0: ordinary scheduling")
      ->check(CLI::Range(0, 98))
      ->capture_default_str();
  loop->add_flag("--json", options->json, "print as JSON");
  runtime::add_bus_options(*loop, options->launch.bus);
  loop->footer("Example: crane bench loop --seconds 60");
  loop->callback([options, &chosen] { chosen = [options] { return bench_loop(*options); }; });
  add_bench_cpu(*command, chosen);
  add_bench_tick(*command, chosen);
  add_bench_fleet(*command, chosen);
  add_bench_stop(*command, chosen);
  add_bench_diagnosis(*command, chosen);
}

}  // namespace crane::cli
