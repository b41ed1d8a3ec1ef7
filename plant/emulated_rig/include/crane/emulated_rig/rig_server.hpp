#pragma once
/// Rig side of the shared lines, in the process crane_emulated_rig. The card side is
/// crane/boards/linked_rig.hpp.
#include <cstdint>
#include <memory>
#include <string>

#include "crane/boards/shared_lines.hpp"
#include "crane/emulated_rig/wired_rig.hpp"

namespace crane::emulated_rig {

/// Simulates the crane and drives its lines.
class RigServer {
 public:
  /// @throws bridge::BoardError when another rig has this name; std::invalid_argument with all problems
  /// of the rig
  RigServer(const configuration::Rig& rig, const std::string& name, bool lockstep, int model);
  ~RigServer();
  RigServer(const RigServer&) = delete;
  RigServer& operator=(const RigServer&) = delete;

  /// Lockstep: waits up to 50 ms for an advance request and serves it.
  void serve_advance();
  /// Real time: waits for a request of the card, at most until `wake_ns` of CLOCK_MONOTONIC, then advances
  /// the crane to the requested time, or without a request to the present time.
  /// @param begin_ns  CLOCK_MONOTONIC at time 0 of the rig
  /// @return true when the card has requested an advance
  bool serve_realtime(std::int64_t begin_ns, std::int64_t wake_ns);
  /// Advances the crane up to `time_ns`, which is `at_ns` of CLOCK_MONOTONIC. Applies each change of the
  /// output lines at its time, then the present levels.
  void run_to(std::int64_t time_ns, std::int64_t at_ns);
  [[nodiscard]] const bridge::SharedLines& lines() const { return *lines_; }
  [[nodiscard]] WiredRig& rig() { return rig_; }

 private:
  const bridge::OutputChange* next_output_change();
  void take_lines();
  void put_lines(std::int64_t at_ns);
  void note_brakes(std::int64_t now_ns);

  std::unique_ptr<bridge::SharedFile> file_;
  bridge::SharedLines* lines_ = nullptr;
  WiredRig rig_;
  std::uint32_t seen_changes_ = 0, seen_kicks_ = 0;
  std::uint64_t seen_output_changes_ = 0;
  bool relay_was_closed_ = false, brakes_were_closed_ = true;
};

}  // namespace crane::emulated_rig
