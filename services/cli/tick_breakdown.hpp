#pragma once
/// Breakdown of the latency of a tick: splits the time from the latched state to the arrival of its command
/// into hops and parts, from the clock stamps of all processes. The parts of a tick add up to its latency
/// exactly.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "crane/bus/path_stamps.hpp"
#include "crane/runtime/wiring.hpp"

namespace crane::cli {

/// Parts of a hop, in the order in which a sample passes them.
enum class Part : std::uint8_t {
  board,     ///< bridge: from the latch to the end of the reading of the board
  law,       ///< from the end of the reading, or from the join, to publish()
  codec,     ///< encoding for the CRC, in writer and reader
  crc,       ///< CRC, in writer and reader
  write,     ///< DDS write, up to its return or to the arrival at the reader, whichever is first
  kernel,    ///< kernel and wake-up: time of a hop of the raw UDP chain, at most the rest of the delivery
  vendor,    ///< rest of the delivery: a DDS thread works or waits for a processor
  handover,  ///< from the DDS thread to the thread of the loop
  take,      ///< DDS take
  join       ///< rest of the poll until the inputs of the tick are complete
};
inline constexpr std::array kPartNames{
    "board",         "law",       "codec", "CRC", "write", "kernel + wake-up",
    "vendor thread", "hand-over", "take",  "join"};
inline constexpr std::size_t kParts = kPartNames.size();
using PerPart = std::array<std::int64_t, kParts>;  ///< [ns]

/// One hop: a process publishes a sample; the next process of the path takes the sample and joins its inputs.
struct Hop {
  std::size_t from = 0, to = 0;  ///< processes, by their index in `processes`
  PerPart parts_ns{};
};

/// The path of one tick, from the latch of the state to the arrival of the command at the clock master.
struct TickPath {
  std::uint64_t tick = 0;
  std::int64_t latency_ns = 0;
  std::vector<Hop> hops;
};

/// Times that were measured outside the loop.
struct Isolated {
  std::array<double, topics::kAll.size()> codec_share{};  ///< encoding / sealing of a sample, by topic
  std::int64_t udp_hop_ns = 0;                            ///< one hop of the raw UDP chain
};

struct TickBreakdown {
  std::vector<TickPath> ticks;
  std::uint64_t left_out = 0;  ///< ticks without a complete path: lost, or overtaken by the next tick
};

/// @param processes  components of the stack; the first is the clock master
/// @param records    records of each component, in the order of `processes`
[[nodiscard]] TickBreakdown break_down(const std::vector<runtime::ComponentSpec>& processes,
                                       const std::vector<std::vector<bus::PathRecord>>& records,
                                       const Isolated& isolated);

/// Sum of each part over the hops of a tick.
[[nodiscard]] PerPart sum_of_hops(const TickPath& path);

}  // namespace crane::cli
