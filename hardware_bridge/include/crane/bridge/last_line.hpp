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
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

/// The part of crane/command that matters here.
struct CommandView {
  std::uint64_t tick = 0;
  std::array<double, kDrives> drive_v{};
  std::array<bool, kDrives> brake_release{};
  bool watchdog_permission = false;
  std::array<bool, kDrives> homing{};  ///< the axis creeps to its mark
};

/// What was measured at the tick that is decided about.
struct Seen {
  std::int64_t time_ns = 0;                      ///< when the counters were latched
  std::array<std::int64_t, kCounters> counts{};  ///< unwrapped
  std::array<double, kCounters> coordinate{};    ///< m, rad, m of cable, rad, rad
  std::array<double, kDrives> applied_v{};       ///< what the converters gave since the tick before
  std::array<bool, kDrives> brake_closed{};
  std::array<bool, kDrives> limit_low{}, limit_high{};
  std::array<bool, kDrives> unknown{};  ///< the axis has to be homed: its coordinate has no known origin
  std::array<bool, kDrives> mark{};     ///< see mark_active()
  bool second_writer = false;           ///< crane/command has had another writer within the last second
};

/// The numbers are those of LatchReason in idl/crane.idl.
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
  drive_response,
  not_homed,
  second_writer
};
inline constexpr std::size_t kReasons = 15;
[[nodiscard]] std::string_view name_of(Reason reason) noexcept;  ///< "encoder_jump"
[[nodiscard]] std::string_view explanation_of(Reason reason) noexcept;
[[nodiscard]] std::string_view remedy_for(Reason reason) noexcept;
/// Whether the counters are not to be trusted from then on, or a brake: no reset helps, a new start does.
/// Where the axes concerned can be homed, that helps, too.
[[nodiscard]] bool is_final(Reason reason) noexcept;

/// One drive axis; unit is m or rad. A limit switch that closes farther inside than the soft margin is a
/// wrong position.
struct AxisLine : control::DriveLimits {
  double certain_motion_v = 5;   ///< more than this moves the axis whatever friction and load do
  double creeping_motion_v = 2;  ///< the same for an axis that creeps to its mark, where less is at stake
  double gain_low = 0;           ///< smallest and largest acceleration per volt, or ...
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
[[nodiscard]] LastLineParameters last_line_parameters(const configuration::Rig& rig);

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
  void shift(std::size_t coordinate, double change) noexcept {
    for (auto& entry : entries_) entry.seen.coordinate[coordinate] += change;
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
/// The counters that encoder_jump or lost_counts is about; none for any other reason.
[[nodiscard]] std::array<bool, kCounters> counters_in_doubt(Reason reason,
                                                            const LastLineParameters& parameters,
                                                            const Moment& moment) noexcept;

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
  /// Axes whose counter the latched reason has put in doubt.
  [[nodiscard]] const std::array<bool, kDrives>& doubted() const { return doubted_; }
  /// A closed brake has stopped the axis.
  [[nodiscard]] bool rests(std::size_t axis) const { return braked_at_[axis].has_value(); }
  /// The same place has another coordinate from the next tick on.
  void shift(std::size_t axis, double change) noexcept;

 private:
  void observe(std::uint64_t tick, const Seen& seen) noexcept;
  void follow_brake(std::size_t axis, std::uint64_t tick, const Seen& seen) noexcept;
  [[nodiscard]] Reason first_failure(const Moment& moment) const noexcept;
  void latch(Reason reason, const Moment& moment) noexcept;
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
  std::array<bool, kDrives> doubted_{};
  bool final_ = false;
  bool permission_withheld_ = false;  ///< seen while latched
};

}  // namespace crane::bridge
