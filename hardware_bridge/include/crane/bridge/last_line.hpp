#pragma once
/// Last check of every command before it reaches the drives ("last line of defence"). The check needs no
/// other process: invalid commands, missing commands and unexpected motion of the rig all lead to a safe
/// output. No I/O and no clock; called once per tick.
///
/// At every tick without a latch, the checks run in the order of last_line_checks(). The first failed check
/// is latched as reason: the drives get 0 V, the brakes lose their supply, and the watchdog output stops
/// toggling.
/// docs/hardware.md describes each check.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "crane/bridge/board.hpp"
#include "crane/configuration/rig.hpp"

namespace crane::bridge {

/// The checked part of crane/command.
struct CommandView {
  std::uint64_t tick = 0;
  std::array<double, kDrives> drive_v{};
  std::array<bool, kDrives> brake_release{};
  bool watchdog_permission = false;
  std::array<bool, kDrives> homing{};  ///< true: the axis is being homed
};

/// Measurements of one tick.
struct Observation {
  std::int64_t time_ns = 0;                      ///< time at which the counters were latched
  std::array<std::int64_t, kCounters> counts{};  ///< unwrapped
  std::array<double, kCounters> coordinate{};    ///< m, rad, m of cable, rad, rad
  std::array<double, kDrives> applied_v{};       ///< output voltage of the converters since the previous tick
  std::array<bool, kDrives> brake_closed{};
  std::array<bool, kDrives> limit_low{}, limit_high{};
  std::array<bool, kDrives> unknown{};  ///< true: the coordinate has no known origin; the axis must be homed
  std::array<bool, kDrives> mark{};     ///< see mark_active()
  bool second_writer = false;  ///< true: crane/command has had a second writer within the last second
};

/// Numbers and meanings are those of LatchReason in idl/crane.idl.
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
/// True when a counter or a brake is no longer trustworthy. Such a latch ends only with a restart of the
/// bridge. Exception: when encoder_jump or lost_counts concerns only axes with a homing mark, a reset ends
/// the latch, and the positions of these axes stay unknown until homing.
[[nodiscard]] bool is_final(Reason reason) noexcept;

/// Parameters of one drive axis; unit is m or rad.
struct AxisCheckParameters : control::DriveLimits {
  double certain_motion_v = 5;         ///< a larger voltage moves the axis against any friction and load
  double certain_homing_motion_v = 2;  ///< as certain_motion_v, during homing of the axis
  /// V: the check fails when the axis accelerates as if driven by this voltage in addition to the command
  double response_margin_v = 2.5;
  /// Smallest and largest gain: unit/s^2 per volt when lag_s is 0, otherwise unit/s per volt.
  double gain_low = 0;
  double gain_high = 0;
  double lag_s = 0;  ///< time constant of a speed-controlled drive; 0: the voltage controls the acceleration
  double unit_per_count = 0;  ///< resolution of the encoder
};

struct LastLineParameters {
  double period_s = 0.01;
  std::uint64_t stale_after_ticks = 5;  ///< the crane stops when the newest command is this old
  std::array<AxisCheckParameters, kDrives> axis{};
  double swing_limit_rad = 1.05;     ///< larger than the supervisor's limit: the supervisor reacts first
  double swing_rate_max_radps = 10;  ///< a larger rate cannot be a motion of the load
  std::array<bool, 2> swing_present{};
};
[[nodiscard]] LastLineParameters last_line_parameters(const configuration::Rig& rig);

/// The last kLength ticks; age 0 is the newest.
class History {
 public:
  struct Entry {
    std::uint64_t tick = 0;
    Observation observation;
    std::array<bool, kDrives> released{};  ///< true: the brake is commanded open
    std::array<bool, kDrives> free{};      ///< true: the brake is commanded open and reports open
  };
  static constexpr std::size_t kLength = 32;

  void add(const Entry& entry) noexcept;
  [[nodiscard]] std::size_t size() const { return size_; }
  /// @pre age < size()
  [[nodiscard]] const Entry& operator[](std::size_t age) const {
    return entries_[(newest_ + kLength - age) % kLength];
  }
  void shift(std::size_t coordinate, double change) noexcept {
    for (auto& entry : entries_) entry.observation.coordinate[coordinate] += change;
  }

 private:
  std::array<Entry, kLength> entries_{};
  std::size_t newest_ = 0, size_ = 0;
};

/// Input of the checks at one tick.
struct CheckInput {
  std::uint64_t tick = 0;
  const CommandView* command = nullptr;  ///< newest command; null: no command since the start
  CommandView before;                    ///< last executed command; default-constructed after a latch
  const History* history = nullptr;      ///< includes this tick
  /// Coordinate at which the closed brake stopped the axis, m or rad; nothing: no brake has stopped the axis.
  std::array<std::optional<double>, kDrives> braked_at{};
};

/// One check: `fails` returns true when `reason` must be latched.
struct Check {
  Reason reason;
  bool (*fails)(const LastLineParameters&, const CheckInput&) noexcept;
};
/// All checks in their order.
[[nodiscard]] std::span<const Check> last_line_checks() noexcept;
/// Counters that fail encoder_jump or lost_counts; none for any other reason.
[[nodiscard]] std::array<bool, kCounters> counters_in_doubt(Reason reason,
                                                            const LastLineParameters& parameters,
                                                            const CheckInput& input) noexcept;

class LastLine {
 public:
  /// @param checks  must outlive this object
  explicit LastLine(const LastLineParameters& parameters, std::span<const Check> checks = last_line_checks())
      : parameters_{parameters}, checks_{checks} {}

  /// @param command  newest command; nothing: no command since the start
  /// @param tick     tick that begins now; the command of tick-1 is due
  [[nodiscard]] Outputs decide(const std::optional<CommandView>& command, std::uint64_t tick,
                               const Observation& observation) noexcept;

  /// The latched reason. A latch that is not final ends after two fresh commands with 0 V and closed brakes:
  /// first one that withholds the watchdog permission (STOP_C0 of the supervisor), then one that grants it
  /// (after the operator's reset), while no second writer is detected.
  [[nodiscard]] Reason reason() const { return reason_; }
  /// Axes whose counter is no longer trustworthy because of the latched reason.
  [[nodiscard]] const std::array<bool, kDrives>& doubted() const { return doubted_; }
  /// True when the closed brake has stopped the axis.
  [[nodiscard]] bool rests(std::size_t axis) const { return braked_at_[axis].has_value(); }
  /// Adds `change` to the stored coordinates after the counter of the axis was set.
  void shift(std::size_t axis, double change) noexcept;

 private:
  void observe(std::uint64_t tick, const Observation& observation) noexcept;
  void follow_brake(std::size_t axis, std::uint64_t tick, const Observation& observation) noexcept;
  [[nodiscard]] Reason first_failure(const CheckInput& input) const noexcept;
  void latch(Reason reason, const CheckInput& input) noexcept;
  void reset_on_permission_edge(const CommandView& command) noexcept;

  LastLineParameters parameters_;
  std::span<const Check> checks_;
  History history_;
  Reason reason_ = Reason::none;
  CommandView before_;
  Outputs executed_;
  /// First tick at which a closed brake must have stopped its axis.
  std::array<std::uint64_t, kDrives> rests_from_tick_{};
  std::array<bool, kDrives> commanded_closed_{};
  std::array<std::optional<double>, kDrives> braked_at_{};
  std::array<bool, kDrives> doubted_{};
  bool final_ = false;
  bool permission_withheld_ = false;  ///< true: a command withheld the permission since the latch
};

}  // namespace crane::bridge
