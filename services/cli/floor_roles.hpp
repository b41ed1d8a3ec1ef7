#pragma once
/// The processes of the floors of `crane bench tick`. No function returns: the measuring process ends them.
#include <array>
#include <atomic>
#include <cstdint>

#include "cli/floors.hpp"

namespace crane::cli {

/// Memory that the processes of one floor share with the measuring process. The times follow it.
struct FloorBoard {
  std::atomic<std::int64_t> begin_ns;  ///< 0: not yet
  std::atomic<int> ready;              ///< processes that are connected
  std::atomic<bool> fifo;
  std::atomic<std::uint64_t> count;  ///< of measured times
  [[nodiscard]] std::int64_t* times_ns() { return reinterpret_cast<std::int64_t*>(this + 1); }
};

/// Time of a floor within the period, as a share. The loop needs the begin of the period.
inline constexpr double kFutexPhase = 0.25, kUdpPhase = 0.35, kCyclonePhase = 0.5, kFastPhase = 0.75;

inline constexpr std::size_t kChainProcesses = 4;

/// Sockets of a chain on the loop-back: process i receives with socket i and sends to process i + 1.
class UdpChain {
 public:
  UdpChain();
  ~UdpChain();
  UdpChain(const UdpChain&) = delete;
  UdpChain& operator=(const UdpChain&) = delete;
  /// The work of one process; process 0 begins each round trip and measures it.
  void pass(FloorBoard& board, const FloorOptions& options, std::size_t process) const;

 private:
  void relay(std::size_t process) const;
  void measure_round_trips(FloorBoard& board, const FloorOptions& options) const;
  void send(std::size_t process, const void* sample) const;
  std::array<int, kChainProcesses> sockets_{-1, -1, -1, -1};
  std::array<std::uint16_t, kChainProcesses> ports_{};
};

/// The work of one process of a chain over DDS.
void pass_over_dds(FloorBoard& board, const FloorOptions& options, bus::Vendor vendor, double phase,
                   std::size_t process);

/// A thread wakes another one through a futex, and waits for the time of its wake-up.
void wake_a_thread(FloorBoard& board, const FloorOptions& options);

}  // namespace crane::cli
