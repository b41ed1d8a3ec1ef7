#pragma once
/// The two ends of the shared lines: the side of the card in the process of the bridge, and the side of the
/// rig in crane_emulated_rig.
#include <memory>
#include <optional>
#include <string>

#include "crane/boards/shared_lines.hpp"
#include "crane/boards/wired_rig.hpp"

namespace crane::bridge {

/// The side of the card.
class LinkedRig final : public EmulatedRig {
 public:
  /// Waits up to 5 s for the rig. @throws BoardError when the rig is missing or another bridge uses the card
  explicit LinkedRig(const std::string& name);

  [[nodiscard]] std::int32_t pulses(std::size_t channel) noexcept override;
  [[nodiscard]] std::uint16_t inputs() noexcept override;
  void set_converter(std::size_t channel, std::uint16_t code) noexcept override;
  void set_outputs(std::uint16_t levels) noexcept override;
  [[nodiscard]] std::int64_t now_ns() noexcept override;
  [[nodiscard]] CardState& card() noexcept override { return lines_->card; }
  void advance_to(std::int64_t time_ns) override;
  void kick(double radial_radps, double tangential_radps) override;
  void require_alive() override;

 private:
  std::unique_ptr<SharedFile> file_;
  SharedLines* lines_ = nullptr;
};

/// Observes the lines of a running rig without changing them.
class RigMonitor {
 public:
  /// @throws BoardError when no rig of this name runs
  explicit RigMonitor(const std::string& name);
  [[nodiscard]] const SharedLines& lines() const { return *lines_; }

 private:
  std::unique_ptr<SharedFile> file_;
  SharedLines* lines_ = nullptr;
};

/// The side of the rig: simulates the crane and drives its lines.
class RigServer {
 public:
  /// @throws BoardError when another rig has this name; std::invalid_argument with all problems of the rig
  RigServer(const runtime::Rig& rig, const std::string& name, bool lockstep, int model);
  ~RigServer();
  RigServer(const RigServer&) = delete;
  RigServer& operator=(const RigServer&) = delete;

  /// Lockstep: waits up to 50 ms for an advance request and serves it.
  void serve_advance();
  /// Real time: advances the crane up to `time_ns`, applies each change of the output lines at its time, and
  /// then the present levels.
  void run_to(std::int64_t time_ns);
  [[nodiscard]] const SharedLines& lines() const { return *lines_; }
  [[nodiscard]] WiredRig& rig() { return rig_; }

 private:
  const OutputChange* next_output_change();
  void take_lines();
  void take_converters();
  void put_lines();
  void note_brakes(std::int64_t now_ns);

  std::unique_ptr<SharedFile> file_;
  SharedLines* lines_ = nullptr;
  WiredRig rig_;
  std::uint32_t seen_changes_ = 0, seen_kicks_ = 0;
  std::uint64_t seen_output_changes_ = 0;
  bool relay_was_closed_ = false, brakes_were_closed_ = true;
};

}  // namespace crane::bridge
