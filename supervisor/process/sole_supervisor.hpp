#pragma once
/// Detects another supervisor of the same crane, at the start and later. No I/O and no clock; the
/// time is an argument.
///
/// While another supervisor publishes crane/supervisor, both refuse reset and arming (disputed()). A
/// supervisor is new at its start and established afterwards (kNew_s). Which of two supervisors exits
/// (yields()):
///   two new ones               the one with the larger start-up number
///   a new and an established   the new one
///   two established ones       none
/// A sample of crane/node alone ends no supervisor, because several processes may write it. crane/supervisor
/// has one writer, and keys authenticate this writer.
#include <cstdint>
#include <optional>
#include <string>

#include "crane/bus/bus.hpp"
#include "process/ticks.hpp"

namespace crane::supervisor {

class SoleSupervisor {
 public:
  /// A supervisor is new for this time or until its first reset, whichever is shorter. Discovery between two
  /// DDS vendors takes up to 1 s.
  static constexpr double kNew_s = 5;
  /// A dispute lasts this long after the last sample of the other supervisor. Same value as
  /// WriterBinding::kDispute_ns and Limits::clear_time_s.
  static constexpr std::int64_t kDispute_ns = 1'000'000'000;

  /// @param epoch     start-up number of this process
  /// @param period_s  duration of a tick, > 0
  SoleSupervisor(std::uint32_t epoch, double period_s)
      : epoch_{epoch}, new_ticks_{ticks_in(kNew_s, period_s)} {}

  /// Processes a sample of crane/supervisor, including those of this process. @param writer  DDS
  /// writer of the sample
  void heard(const msg::SupervisorStatus& status, const bus::WriterId& writer, std::int64_t now_ns);
  /// Processes a sample of crane/node of any process.
  void heard(const msg::NodeStatus& status);
  /// Call once for each published status of this process.
  void stepped(crane_SupervisorState state);

  /// @return true while another supervisor has published crane/supervisor within the last kDispute_ns
  [[nodiscard]] bool disputed(std::int64_t now_ns) const {
    return disputed_ns_ && now_ns - *disputed_ns_ < kDispute_ns;
  }
  /// @return true when this process must exit
  [[nodiscard]] bool yields() const {
    return is_new_ && rival_ && rival_->publishes && (rival_->established || rival_->epoch < epoch_);
  }
  /// The other supervisor, for messages: "supervisor with start-up number 4711, process 123 (fastdds)".
  [[nodiscard]] std::string rival() const;

 private:
  struct Rival {
    std::uint32_t epoch = 0;
    bool publishes = false;  ///< true: it has published crane/supervisor
    bool established = false;
    std::uint32_t pid = 0;  ///< 0: not known yet
    std::string vendor;
  };
  Rival& rival_with(std::uint32_t epoch);

  std::uint32_t epoch_;
  std::uint64_t new_ticks_;
  std::uint64_t ticks_ = 0;
  bool is_new_ = true;
  std::optional<bus::WriterId> own_writer_;
  std::optional<Rival> rival_;
  std::optional<std::int64_t> disputed_ns_;
};

}  // namespace crane::supervisor
