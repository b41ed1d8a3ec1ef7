#include "cli/floors.hpp"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <functional>
#include <iostream>
#include <new>
#include <stdexcept>

#include "cli/floor_roles.hpp"
#include "crane/runtime/spin_limit.hpp"

namespace crane::cli {

struct Floors::Running {
  std::string name, title;
  std::size_t bytes;
  FloorBoard* board;
  std::vector<pid_t> processes{};

  Running(std::string short_name, std::string long_name, std::size_t ticks)
      : name{std::move(short_name)},
        title{std::move(long_name)},
        bytes{sizeof(FloorBoard) + ticks * sizeof(std::int64_t)} {
    void* at = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED)
      throw std::runtime_error{std::string{"cannot share memory: "} + std::strerror(errno)};
    board = new (at) FloorBoard{};
  }
  ~Running() { ::munmap(board, bytes); }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
};

namespace {

using Role = std::function<void(FloorBoard&)>;

/// Requests the scheduling of the loop. Threads that this thread starts later inherit it.
void schedule(FloorBoard& board, int priority) {
  if (priority <= 0) return;
  runtime::limit_spin_time();
  const sched_param parameters{.sched_priority = priority};
  board.fifo = ::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0;
}

/// Runs a role in a child process, which the kernel ends when this process ends.
pid_t start(FloorBoard& board, int priority, const Role& role) {
  const auto parent = ::getpid();
  const auto pid = ::fork();
  if (pid < 0) throw std::runtime_error{std::string{"cannot start a process: "} + std::strerror(errno)};
  if (pid != 0) return pid;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(runtime::kExitFailed);
  std::signal(SIGINT, SIG_IGN);  // Ctrl-C reaches the measuring process, which ends the floors
  try {
    schedule(board, priority);
    role(board);
  } catch (const std::exception& error) {
    std::cerr << "floor: " << error.what() << std::endl;
  }
  ::_exit(runtime::kExitFailed);
}

}  // namespace

Floors::Floors(const FloorOptions& options) {
  const auto add = [&](const char* name, const char* title, std::size_t processes,
                       const std::function<void(FloorBoard&, std::size_t)>& role) {
    auto& floor = *floors_.emplace_back(std::make_unique<Running>(name, title, options.ticks));
    for (std::size_t i = 0; i < processes; ++i)
      floor.processes.push_back(
          cli::start(*floor.board, options.priority, [&](FloorBoard& board) { role(board, i); }));
  };
  const auto dds = [&options](bus::Vendor vendor, double phase) {
    return [&options, vendor, phase](FloorBoard& board, std::size_t process) {
      pass_over_dds(board, options, vendor, phase, process);
    };
  };
  try {
    const UdpChain udp;
    add("futex", "futex wake-up, two threads", 1,
        [&](FloorBoard& board, std::size_t) { wake_a_thread(board, options); });
    add("udp_chain", "raw UDP, chain of four processes", kChainProcesses,
        [&](FloorBoard& board, std::size_t process) { udp.pass(board, options, process); });
    add("cyclone_chain", "bare Cyclone DDS, chain of four processes", kChainProcesses,
        dds(bus::Vendor::cyclone, kCyclonePhase));
    add("fastdds_chain", "bare Fast DDS, chain of four processes", kChainProcesses,
        dds(bus::Vendor::fastdds, kFastPhase));
  } catch (...) {
    end();
    throw;
  }
}
Floors::~Floors() { end(); }

void Floors::wait_until_ready(std::chrono::milliseconds patience) const {
  const auto end_ns = runtime::monotonic_ns() + std::chrono::nanoseconds{patience}.count();
  for (const auto& floor : floors_)
    while (floor->board->ready < static_cast<int>(floor->processes.size())) {
      for (const auto pid : floor->processes)
        if (::kill(pid, 0) != 0 || ::waitpid(pid, nullptr, WNOHANG) == pid)
          throw std::runtime_error{floor->title + ": a process has ended"};
      if (runtime::stop_requested()) throw std::runtime_error{"interrupted"};
      if (runtime::monotonic_ns() > end_ns)
        throw std::runtime_error{floor->title + ": not connected after " + std::to_string(patience.count()) +
                                 " ms"};
      ::usleep(5'000);
    }
}

void Floors::begin(std::int64_t tick_ns) {
  for (const auto& floor : floors_) floor->board->begin_ns = tick_ns;
}

void Floors::end() noexcept {
  for (const auto& floor : floors_)
    for (const auto pid : floor->processes) ::kill(pid, SIGKILL);
  for (const auto& floor : floors_) {
    for (const auto pid : floor->processes) ::waitpid(pid, nullptr, 0);
    floor->processes.clear();
  }
}

std::vector<Floor> Floors::finish() {
  end();
  std::vector<Floor> measured;
  for (const auto& floor : floors_) {
    Floor one{.name = floor->name, .title = floor->title, .fifo = floor->board->fifo, .times_us = {}};
    for (std::uint64_t i = 0; i < floor->board->count; ++i)
      one.times_us.push_back(static_cast<double>(floor->board->times_ns()[i]) / 1e3);
    if (one.times_us.empty()) throw std::runtime_error{floor->title + ": no sample has passed"};
    measured.push_back(std::move(one));
  }
  return measured;
}

}  // namespace crane::cli
