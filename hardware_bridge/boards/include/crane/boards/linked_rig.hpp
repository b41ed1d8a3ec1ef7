#pragma once
/// The two ends of the shared lines: the card's side in the bridge's process, the rig's side in
/// crane_emulated_rig.
#include <memory>
#include <optional>
#include <string>

#include "crane/boards/shared_lines.hpp"
#include "crane/boards/wired_rig.hpp"

namespace crane::bridge {

/// The card's side.
class LinkedRig final : public EmulatedRig {
 public:
  /// Waits up to 5 s for the rig to be there. @throws BoardError when it is not, or another bridge has the
  /// card
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

/// Somebody who looks at the lines of a rig that runs, and touches nothing.
class RigMonitor {
 public:
  /// @throws BoardError when no rig of this name runs
  explicit RigMonitor(const std::string& name);
  [[nodiscard]] const SharedLines& lines() const { return *lines_; }

 private:
  std::unique_ptr<SharedFile> file_;
  SharedLines* lines_ = nullptr;
};

/// The rig's side: the crane, and what of it is on the lines.
class RigServer {
 public:
  /// @throws BoardError when another rig has this name; std::invalid_argument naming problems of the rig
  RigServer(const configuration::Rig& rig, const std::string& name, bool lockstep, int model);
  ~RigServer();
  RigServer(const RigServer&) = delete;
  RigServer& operator=(const RigServer&) = delete;

  /// Lockstep: waits up to 50 ms for an advance request and serves it.
  void serve_advance();
  /// Real time: the crane runs on to `time_ns`, with each change of the output lines at its moment, then sees
  /// what is on the lines now.
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
