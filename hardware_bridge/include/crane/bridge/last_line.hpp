#pragma once
/// The bridge's own decision what reaches the drives. It needs nobody: whatever the commands are, or when
/// none come, the answer is safe. Pure; called once a tick.
#include <array>
#include <cstdint>
#include <optional>

#include "crane/bridge/board.hpp"

namespace crane::bridge {

/// The part of crane/command that matters here.
struct CommandView {
  std::uint64_t tick = 0;
  std::array<double, kDrives> drive_v{};
  std::array<bool, kDrives> brake_release{};
  bool watchdog_permission = false;
};

struct LastLineParameters {
  std::uint64_t stale_after_ticks = 5;  ///< command age that stops the crane
  std::array<double, kDrives> volt_limit_v{10, 10, 10};
};

class LastLine {
 public:
  explicit LastLine(const LastLineParameters& parameters) : parameters_{parameters} {}

  /// @param command  the newest command there is; nothing: none came since start
  /// @param tick     the tick whose interval begins now; the command of tick-1 is due
  [[nodiscard]] Outputs decide(const std::optional<CommandView>& command, std::uint64_t tick) noexcept;

  /// Latched reasons. They fall when fresh commands first withhold and then grant the watchdog permission,
  /// as the supervisor does on an operator's reset.
  [[nodiscard]] bool command_stale() const { return stale_; }
  [[nodiscard]] bool command_invalid() const { return invalid_; }

 private:
  [[nodiscard]] bool acceptable(const CommandView& command) const noexcept;
  void reset_on_permission_edge(const CommandView& command) noexcept;

  LastLineParameters parameters_;
  bool stale_ = false, invalid_ = false;
  bool permission_withheld_ = false;  ///< seen while latched
  bool watchdog_level_ = false;
};

}  // namespace crane::bridge
