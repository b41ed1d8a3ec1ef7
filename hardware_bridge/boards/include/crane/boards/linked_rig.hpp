#pragma once
/// Card side of the shared lines, in the process of the bridge. plant/emulated_rig contains the rig
/// side.
#include <memory>
#include <string>

#include "crane/boards/emulated_rig.hpp"
#include "crane/boards/shared_lines.hpp"

namespace crane::bridge {

class LinkedRig final : public EmulatedRig {
 public:
  /// Waits up to 5 s for the rig. @throws BoardError when the rig is missing or another bridge uses the card
  explicit LinkedRig(const std::string& name);

  [[nodiscard]] std::int32_t pulses(std::size_t channel) noexcept override;
  [[nodiscard]] std::uint16_t inputs() noexcept override;
  void set_converter(std::size_t channel, std::uint16_t code) noexcept override;
  void set_outputs(std::uint16_t levels) noexcept override;
  [[nodiscard]] bool latch_is_stuck() noexcept override { return (lines_->faults & kStuckLatches) != 0; }
  [[nodiscard]] std::int64_t now_ns() noexcept override;
  [[nodiscard]] CardState& card() noexcept override { return lines_->card; }
  void advance_to(std::int64_t time_ns) override;
  void kick(double radial_radps, double tangential_radps) override;
  void require_alive() override;

 private:
  void advance_to_now();

  std::unique_ptr<SharedFile> file_;
  SharedLines* lines_ = nullptr;
};

/// Observes the lines of a running rig without changing them. Tests also inject faults of the card.
class RigMonitor {
 public:
  /// @throws BoardError when no rig of this name runs
  explicit RigMonitor(const std::string& name);
  [[nodiscard]] const SharedLines& lines() const { return *lines_; }
  /// @param faults  sum of CardFault; 0: none
  void inject(std::uint32_t faults) { lines_->faults = faults; }

 private:
  std::unique_ptr<SharedFile> file_;
  SharedLines* lines_ = nullptr;
};

}  // namespace crane::bridge
