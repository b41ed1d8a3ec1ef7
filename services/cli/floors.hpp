#pragma once
/// Floors of `crane bench tick`: lower bounds of the latency of a tick, measured without code of this
/// project. In three chains, four processes pass the samples of one tick in a ring, over UDP sockets, Cyclone
/// DDS and Fast DDS. In a fourth floor, a thread wakes a second thread through a futex. Each floor runs in a
/// separate part of the period, so that it does not delay the loop.
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "crane/runtime/process.hpp"

namespace crane::cli {

struct FloorOptions {
  runtime::BusOptions bus;
  std::int64_t period_ns = 10'000'000;
  std::size_t ticks = 0;  ///< largest number of measured times per floor
  int priority = 0;       ///< SCHED_FIFO; 0: ordinary scheduling
};

/// Measured times of one floor.
struct Floor {
  std::string name;   ///< "udp_chain"
  std::string title;  ///< "raw UDP, four processes"
  bool fifo = false;  ///< true: its processes run with SCHED_FIFO
  std::vector<double> times_us;
};

class Floors {
 public:
  /// Starts the processes. @pre this process has one thread. @throws std::runtime_error
  explicit Floors(const FloorOptions& options);
  ~Floors();  ///< ends the processes
  Floors(const Floors&) = delete;
  Floors& operator=(const Floors&) = delete;

  /// @throws std::runtime_error when a chain is not connected within `patience`, or a process has ended
  void wait_until_ready(std::chrono::milliseconds patience) const;
  /// Begins to measure. @param tick_ns  start of a tick of the loop, CLOCK_MONOTONIC
  void begin(std::int64_t tick_ns);
  /// Ends the processes. @return the measured times
  [[nodiscard]] std::vector<Floor> finish();

 private:
  struct Running;  ///< one floor
  void end() noexcept;
  std::vector<std::unique_ptr<Running>> floors_;
};

}  // namespace crane::cli
