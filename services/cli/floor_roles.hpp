#pragma once
/// Main functions of the floor processes of `crane bench tick`. They do not return: the measuring process
/// ends the floor processes.
#include <array>
#include <atomic>
#include <cstdint>

#include "cli/floors.hpp"

namespace crane::cli {

/// Head of the memory that the processes of one floor share with the measuring process. The array of measured
/// times follows the head.
struct FloorBoard {
  std::atomic<std::int64_t>
      begin_ns;                      ///< start of a tick of the loop, CLOCK_MONOTONIC; 0: do not measure yet
  std::atomic<int> ready;            ///< number of connected processes
  std::atomic<bool> fifo;            ///< true: the processes run with SCHED_FIFO
  std::atomic<std::uint64_t> count;  ///< number of measured times
  [[nodiscard]] std::int64_t* times_ns() { return reinterpret_cast<std::int64_t*>(this + 1); }
};

/// Start of each floor within the control period, as a share of the period. The loop uses the first part.
inline constexpr double kFutexPhase = 0.25, kUdpPhase = 0.35, kCyclonePhase = 0.5, kFastPhase = 0.75;

inline constexpr std::size_t kChainProcesses = 4;

/// Sockets of a chain on the loop-back: process i receives with socket i and sends to process i + 1.
class UdpChain {
 public:
  UdpChain();
  ~UdpChain();
  UdpChain(const UdpChain&) = delete;
  UdpChain& operator=(const UdpChain&) = delete;
  /// Main function of one process. Process 0 starts and measures each round trip.
  void pass(FloorBoard& board, const FloorOptions& options, std::size_t process) const;

 private:
  void relay(std::size_t process) const;
  void measure_round_trips(FloorBoard& board, const FloorOptions& options) const;
  void send(std::size_t process, const void* sample) const;
  std::array<int, kChainProcesses> sockets_{-1, -1, -1, -1};
  std::array<std::uint16_t, kChainProcesses> ports_{};
};

/// Main function of one process of a chain over DDS.
void pass_over_dds(FloorBoard& board, const FloorOptions& options, bus::Vendor vendor, double phase,
                   std::size_t process);

/// Measures the time from a futex wake call to the wake-up of a second thread.
void wake_a_thread(FloorBoard& board, const FloorOptions& options);

}  // namespace crane::cli
