#pragma once
/// The bridge's own decision what reaches the drives. It needs nobody: whatever the commands are, or when
/// none come, and whatever the rig does, the answer is safe. Pure; called once a tick.
///
/// Every tick all checks are made. The first that fails is latched with its reason: 0 V, brakes without
/// supply, the watchdog output rests. Reasons are listed, with what each check compares, in docs/hardware.md.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "crane/bridge/board.hpp"
#include "crane/runtime/rig.hpp"

namespace crane::bridge {

/// The part of crane/command that matters here.
struct CommandView {
  std::uint64_t tick = 0;
  std::array<double, kDrives> drive_v{};
  std::array<bool, kDrives> brake_release{};
  bool watchdog_permission = false;
};

/// What was measured at the tick that is decided about.
struct Seen {
  std::array<std::int64_t, kCounters> counts{};  ///< unwrapped
  std::array<double, kCounters> coordinate{};    ///< m, rad, m of cable, rad, rad
  std::array<double, kDrives> applied_v{};       ///< what the converters gave since the tick before
  std::array<bool, kDrives> brake_closed{};
  std::array<bool, kDrives> limit_low{}, limit_high{};
};

enum class Reason : std::uint8_t {
  none,
  command_stale,
  command_not_finite,
  command_range,
  command_rate,
  position,
  speed,
  swing,
  encoder_jump,
  lost_counts,
  braked_motion,
  encoder_frozen,
  drive_response
};
[[nodiscard]] std::string_view name_of(Reason reason) noexcept;  ///< "encoder_jump"
[[nodiscard]] std::string_view explanation_of(Reason reason) noexcept;
[[nodiscard]] std::string_view remedy_for(Reason reason) noexcept;
/// Whether the position is unknown, or a brake not to be trusted, from then on: no reset helps, a new start
/// does.
[[nodiscard]] bool is_final(Reason reason) noexcept;

/// One drive axis; unit is m or rad.
struct AxisLine {
  bool present = false;
  double volt_limit_v = 10, volt_rate_limit_vps = 1000;
  double low_limit = 0, high_limit = 0;  ///< hard limits
  double soft_margin = 0;                ///< a limit switch that closes farther inside is a wrong position
  double max_speed = 0;                  ///< unit/s
  double brake_deceleration = 0;         ///< unit/s^2
  double brake_close_time_s = 0.02;
  double brake_slip = 0.02;     ///< displacement that a closed brake may allow
  double certain_motion_v = 5;  ///< more than this moves the axis whatever its friction
  double gain_low = 0;          ///< smallest and largest acceleration per volt, or ...
  double gain_high = 0;
  double lag_s = 0;  ///< ... speed per volt of a drive with this time constant
};

struct LastLineParameters {
  double period_s = 0.01;
  std::uint64_t stale_after_ticks = 5;  ///< command age that stops the crane
  std::array<AxisLine, kDrives> axis{};
  double swing_limit_rad = 1.05;     ///< beyond what the supervisor answers
  double swing_rate_max_radps = 10;  ///< faster is no motion of a load
  std::array<bool, 2> swing_present{};
};
[[nodiscard]] LastLineParameters last_line_parameters(const runtime::Rig& rig);

/// The last ticks, newest first.
class History {
 public:
  struct Entry {
    std::uint64_t tick = 0;
    Seen seen;
    std::array<bool, kDrives> free{};  ///< brake open, told and reported
  };
  static constexpr std::size_t kLength = 32;

  void add(const Entry& entry) noexcept;
  [[nodiscard]] std::size_t size() const { return size_; }
  /// @pre age < size()
  [[nodiscard]] const Entry& operator[](std::size_t age) const {
    return entries_[(newest_ + kLength - age) % kLength];
  }

 private:
  std::array<Entry, kLength> entries_{};
  std::size_t newest_ = 0, size_ = 0;
};

/// Everything a check may look at.
struct Moment {
  std::uint64_t tick = 0;
  const CommandView* command = nullptr;  ///< newest; null: none came since start
  CommandView before;                    ///< last command that was obeyed; after a latch: nothing
  const History* history = nullptr;      ///< this tick included
  std::array<std::optional<double>, kDrives>
      braked_at{};  ///< where an axis came to rest under its closed brake
};

struct Check {
  Reason reason;
  bool (*fails)(const LastLineParameters&, const Moment&) noexcept;
};
/// In the order in which they are made.
[[nodiscard]] std::span<const Check> last_line_checks() noexcept;

class LastLine {
 public:
  /// @param checks  must outlive the line
  explicit LastLine(const LastLineParameters& parameters, std::span<const Check> checks = last_line_checks())
      : parameters_{parameters}, checks_{checks} {}

  /// @param command  the newest command there is; nothing: none came since start
  /// @param tick     the tick whose interval begins now; the command of tick-1 is due
  [[nodiscard]] Outputs decide(const std::optional<CommandView>& command, std::uint64_t tick,
                               const Seen& seen) noexcept;

  /// Latched. It falls when fresh commands first withhold and then grant the watchdog permission, as the
  /// supervisor does on an operator's reset, unless it is final.
  [[nodiscard]] Reason reason() const { return reason_; }

 private:
  void observe(std::uint64_t tick, const Seen& seen) noexcept;
  void follow_brake(std::size_t axis, std::uint64_t tick, const Seen& seen) noexcept;
  [[nodiscard]] Reason first_failure(const Moment& moment) const noexcept;
  void reset_on_permission_edge(const CommandView& command) noexcept;

  LastLineParameters parameters_;
  std::span<const Check> checks_;
  History history_;
  Reason reason_ = Reason::none;
  CommandView before_;
  Outputs given_;
  std::array<std::uint64_t, kDrives> rests_from_tick_{};  ///< a closed brake has stopped its axis by then
  std::array<bool, kDrives> told_closed_{};
  std::array<std::optional<double>, kDrives> braked_at_{};
  bool permission_withheld_ = false;  ///< seen while latched
};

}  // namespace crane::bridge
