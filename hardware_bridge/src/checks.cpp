/// The checks of LastLine, one function per reason. A NaN in a command fails command_not_finite, a NaN in a
/// coordinate fails encoder_jump.
#include <algorithm>
#include <cmath>

#include "crane/bridge/last_line.hpp"
#include "crane/configuration/encoder_resolution.hpp"

namespace crane::bridge {
namespace {

constexpr double kRounding_v = 1e-9;

bool requests_motion(const CommandView& command, std::size_t axis) {
  return command.brake_release[axis] || command.drive_v[axis] != 0;
}

/// Time between two samples, including any delay; at least a hundredth of a period, to avoid a division by 0.
double seconds(const LastLineParameters& parameters, const CheckInput& input, std::size_t newer,
               std::size_t older) {
  constexpr double kShortest_periods = 0.01;
  const auto& history = *input.history;
  const auto elapsed_ns = history[newer].observation.time_ns - history[older].observation.time_ns;
  return std::max(static_cast<double>(elapsed_ns) / 1e9, kShortest_periods * parameters.period_s);
}

/// Mean speed in the tick that ended `age` entries ago, unit/s.
double speed(const LastLineParameters& parameters, const CheckInput& input, std::size_t coordinate,
             std::size_t age = 0) {
  const auto& history = *input.history;
  if (history.size() < age + 2) return 0;
  return (history[age].observation.coordinate[coordinate] -
          history[age + 1].observation.coordinate[coordinate]) /
         seconds(parameters, input, age, age + 1);
}

template <class AxisFails>
bool any_axis(const LastLineParameters& parameters, const AxisFails& fails) {
  for (std::size_t i = 0; i < kDrives; ++i)
    if (parameters.axis[i].present && fails(i, parameters.axis[i])) return true;
  return false;
}

bool command_stale(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  if (input.command == nullptr)
    return false;  // no command since the start: the outputs are 0 V and closed brakes
  const auto tick = input.command->tick;
  return tick >= input.tick || input.tick - 1 - tick >= parameters.stale_after_ticks;
}

bool command_not_finite(const LastLineParameters& /*parameters*/, const CheckInput& input) noexcept {
  return input.command != nullptr &&
         !std::all_of(input.command->drive_v.begin(), input.command->drive_v.end(),
                      [](double v) { return std::isfinite(v); });
}

bool command_range(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  if (input.command == nullptr) return false;
  for (std::size_t i = 0; i < kDrives; ++i)
    if (std::isfinite(input.command->drive_v[i]) &&
        std::abs(input.command->drive_v[i]) > parameters.axis[i].volt_limit_v + kRounding_v)
      return true;
  return false;
}

/// Every step towards 0 V is permitted, because it brings the crane to rest.
bool command_rate(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  if (input.command == nullptr) return false;
  const auto ticks = input.command->tick > input.before.tick ? input.command->tick - input.before.tick : 0;
  for (std::size_t i = 0; i < kDrives; ++i) {
    const double u = input.command->drive_v[i], last = input.before.drive_v[i];
    const bool towards_zero = u * last >= 0 && std::abs(u) <= std::abs(last);
    const double most =
        parameters.axis[i].volt_rate_limit_vps * parameters.period_s * static_cast<double>(ticks);
    if (std::isfinite(u) && !towards_zero && std::abs(u - last) > most + kRounding_v) return true;
  }
  return false;
}

/// An axis without known position may only creep, and only while it is being homed. The speed is a mean over
/// several ticks, because an axis that breaks loose from static friction is briefly faster.
bool not_homed(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  constexpr double kCreepingMargin = 3, kWindow_s = 0.05;
  if (input.command == nullptr) return false;
  const auto& history = *input.history;
  const auto ticks = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::llround(kWindow_s / parameters.period_s)), 1, History::kLength - 1);
  return any_axis(parameters, [&](std::size_t i, const AxisCheckParameters& axis) {
    if (!history[0].observation.unknown[i] || !requests_motion(*input.command, i)) return false;
    if (!input.command->homing[i] ||
        !(std::abs(input.command->drive_v[i]) <= axis.homing.volt_limit_v + kRounding_v))
      return true;
    if (history.size() <= ticks) return false;
    const double distance = history[0].observation.coordinate[i] - history[ticks].observation.coordinate[i];
    return !(std::abs(distance) / seconds(parameters, input, 0, ticks) <=
             kCreepingMargin * axis.homing.speed);
  });
}

/// True when a command moves an axis that is beyond a hard limit, or that cannot stop before one.
/// Stopping point: x +- (v t_brake + v^2 / 2a).
bool position_fails(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  if (input.command == nullptr) return false;
  return any_axis(parameters, [&](std::size_t i, const AxisCheckParameters& axis) {
    if (!requests_motion(*input.command, i) || (*input.history)[0].observation.unknown[i]) return false;
    const double x = (*input.history)[0].observation.coordinate[i];
    const double v = speed(parameters, input, i);
    const double distance = std::abs(v) * axis.brake_close_time_s + v * v / (2 * axis.brake_deceleration);
    const double ahead = v > 0 ? x + distance : x;
    const double behind = v < 0 ? x - distance : x;
    return !(ahead <= axis.high_limit && behind >= axis.low_limit);
  });
}

bool overspeed(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  return any_axis(parameters, [&](std::size_t i, const AxisCheckParameters& axis) {
    return !(std::abs(speed(parameters, input, i)) <= configuration::kBridgeSpeedMargin * axis.max_speed);
  });
}

bool swing_fails(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  if (input.command == nullptr) return false;
  bool motion_commanded = false;
  for (std::size_t i = 0; i < kDrives; ++i)
    motion_commanded = motion_commanded || requests_motion(*input.command, i);
  for (std::size_t i = 0; i < parameters.swing_present.size(); ++i)
    if (motion_commanded && parameters.swing_present[i] &&
        !(std::abs((*input.history)[0].observation.coordinate[kDrives + i]) <= parameters.swing_limit_rad))
      return true;
  return false;
}

/// True when the counter changed in one tick by more than any motion can explain.
bool jumped(const LastLineParameters& parameters, const CheckInput& input, std::size_t counter) noexcept {
  constexpr double kMotionMargin = 2;
  const bool drive = counter < kDrives;
  if (drive ? !parameters.axis[counter].present : !parameters.swing_present[counter - kDrives]) return false;
  const double fastest = drive ? parameters.axis[counter].max_speed : parameters.swing_rate_max_radps;
  return !(std::abs(speed(parameters, input, counter)) <= kMotionMargin * fastest);
}

bool encoder_jump(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  for (std::size_t i = 0; i < kCounters; ++i)
    if (jumped(parameters, input, i)) return true;
  return false;
}

/// True when the homing mark operates farther than `back_off` from its position.
bool mark_disagrees(const AxisCheckParameters& axis, const CheckInput& input, std::size_t i) noexcept {
  const auto& history = *input.history;
  if (!axis.homes() || history.size() < 2 || history[1].observation.unknown[i]) return false;
  if (history[0].observation.mark[i] == history[1].observation.mark[i]) return false;
  const double now = history[0].observation.coordinate[i], before = history[1].observation.coordinate[i];
  const double low = std::min(now, before) - axis.homing.back_off;
  const double high = std::max(now, before) + axis.homing.back_off;
  return !(axis.homing.position >= low && axis.homing.position <= high);
}

/// A limit switch is a reference mark: if the switch is pressed at a measured position far from the limit,
/// the encoder has lost counts.
bool counts_lost(const LastLineParameters& parameters, const CheckInput& input, std::size_t i) noexcept {
  const AxisCheckParameters& axis = parameters.axis[i];
  const auto& observation = (*input.history)[0].observation;
  if (!axis.present || observation.unknown[i]) return false;
  return (observation.limit_low[i] && observation.coordinate[i] > axis.low_limit + axis.soft_margin) ||
         (observation.limit_high[i] && observation.coordinate[i] < axis.high_limit - axis.soft_margin) ||
         mark_disagrees(axis, input, i);
}

bool lost_counts(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  return any_axis(parameters, [&](std::size_t i, const AxisCheckParameters& /*axis*/) {
    return counts_lost(parameters, input, i);
  });
}

bool braked_motion(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  return any_axis(parameters, [&](std::size_t i, const AxisCheckParameters& axis) {
    return input.braked_at[i] &&
           std::abs((*input.history)[0].observation.coordinate[i] - *input.braked_at[i]) > axis.brake_slip;
  });
}

constexpr std::int64_t kFlicker_counts = 2;  // largest change of the counts of an axis at rest

bool unmoved(const History& history, std::size_t i, std::size_t newer, std::size_t older) {
  return std::abs(history[newer].observation.counts[i] - history[older].observation.counts[i]) <=
         kFlicker_counts;
}

/// Number of consecutive ticks, up to this tick, in which the axis was free, the voltage had its present
/// sign, and the counter changed by at most kFlicker_counts.
std::size_t ticks_without_motion(const History& history, std::size_t i) {
  const double side = history[0].observation.applied_v[i] > 0 ? 1 : -1;
  std::size_t ticks = 0;
  while (ticks + 1 < history.size() && history[ticks].free[i] &&
         side * history[ticks].observation.applied_v[i] > 0 && unmoved(history, i, 0, ticks + 1))
    ++ticks;
  return ticks;
}

/// Largest speed against the present voltage at the beginning of the ticks without motion, unit/s, <= 0. The
/// counter hides a reversal: the axis returns to where it came from. A speed that has grown linearly from
/// rest is twice its mean.
double reversed_speed(const LastLineParameters& parameters, const AxisCheckParameters& axis,
                      const CheckInput& input, std::size_t i, std::size_t ticks) {
  constexpr double kMean_s = 0.05, kFinalPerMean = 2;
  const auto& history = *input.history;
  const auto span = static_cast<std::size_t>(std::max(std::llround(kMean_s / parameters.period_s), 1LL));
  const std::size_t oldest = std::min(ticks + span, history.size() - 1);
  if (oldest <= ticks) return 0;
  const double side = history[0].observation.applied_v[i] > 0 ? 1 : -1;
  const double moved =
      side * (history[ticks].observation.coordinate[i] - history[oldest].observation.coordinate[i]);
  if (!(moved < 0)) return 0;
  return (kFinalPerMean * moved - axis.unit_per_count) / seconds(parameters, input, ticks, oldest);
}

/// True when an axis with known position must have moved by a visible distance while its counter changed by
/// at most kFlicker_counts. The distance is a lower bound: from rest or from reversed_speed(), smallest gain,
/// 1.5 times the friction, largest force of the load.
bool motion_is_missing(const LastLineParameters& parameters, const AxisCheckParameters& axis,
                       const CheckInput& input, std::size_t i) {
  constexpr double kLeastVisible = 0.005;  // m, rad, m of cable: twenty times the backlash of a gear
  const double visible = std::max(kLeastVisible, (kFlicker_counts + 1) * axis.unit_per_count);
  const auto& history = *input.history;
  const std::size_t ticks = ticks_without_motion(history, i);
  double least_distance = 0, least_speed = reversed_speed(parameters, axis, input, i, ticks);
  for (std::size_t age = ticks; age-- > 0;) {
    const double net_v =
        std::max(std::abs(history[age].observation.applied_v[i]) - axis.certain_motion_v, 0.0);
    if (axis.lag_s > 0)
      least_speed += (axis.gain_low * net_v - least_speed) * std::min(parameters.period_s / axis.lag_s, 1.0);
    else
      least_speed += axis.gain_low * net_v * parameters.period_s;
    least_distance += least_speed * parameters.period_s;
  }
  return least_distance > visible;
}

/// The voltage exceeds friction and load, the brake is open, and the counter changes by at most
/// kFlicker_counts: the encoder is dead, or the brake has not opened.
bool encoder_frozen(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  constexpr double kWindow_s = 0.1;
  const auto window = static_cast<std::size_t>(std::llround(kWindow_s / parameters.period_s));
  const auto ticks = std::clamp<std::size_t>(window, 2, History::kLength - 1);
  const auto& history = *input.history;
  return any_axis(parameters, [&](std::size_t i, const AxisCheckParameters& axis) {
    if (!history[0].observation.unknown[i]) return motion_is_missing(parameters, axis, input, i);
    if (ticks_without_motion(history, i) < ticks) return false;
    for (std::size_t age = 0; age < ticks; ++age)
      if (std::abs(history[age].observation.applied_v[i]) < axis.certain_homing_motion_v) return false;
    return true;
  });
}

/// Increase of speed that the voltages of the last ticks do not explain, as equivalent voltage, V.
/// Friction and brakes only reduce the speed and are ignored.
double unexplained_v(const LastLineParameters& parameters, const CheckInput& input, std::size_t i,
                     std::size_t age) {
  const auto ticks = [&parameters](double time_s, std::size_t most) {
    return std::clamp<std::size_t>(static_cast<std::size_t>(std::llround(time_s / parameters.period_s)), 2,
                                   most);
  };
  const std::size_t span = ticks(0.05, 14), remembered = ticks(0.12, 24);
  const auto& history = *input.history;
  const AxisCheckParameters& axis = parameters.axis[i];
  if (history.size() < age + remembered + 2) return 0;
  const double v = speed(parameters, input, i, age);
  const double side = v > 0 ? 1 : -1;
  // After a reversal, only the increase from standstill counts, because friction explains the stop.
  const double before = std::max(side * speed(parameters, input, i, age + span), 0.0);
  double gained = (std::abs(v) - before) / seconds(parameters, input, age, age + span);
  double most_v = side * history[age].observation.applied_v[i];
  for (std::size_t k = 1; k < remembered; ++k)
    most_v = std::max(most_v, side * history[age + k].observation.applied_v[i]);
  if (axis.lag_s > 0) gained = gained * axis.lag_s + std::abs(v);  // voltage of a speed-controlled drive
  if (!(gained > 0)) return 0;  // friction can hold the axis against its drive
  return (gained - most_v * (most_v > 0 ? axis.gain_high : axis.gain_low)) / axis.gain_high;
}

/// Not checked while the brake is commanded closed: the drive then has 0 V, and braked_motion checks the
/// axis. The margin covers the force of the load.
bool drive_response(const LastLineParameters& parameters, const CheckInput& input) noexcept {
  constexpr std::size_t kInRow = 3;
  return any_axis(parameters, [&](std::size_t i, const AxisCheckParameters& axis) {
    for (std::size_t age = 0; age < kInRow; ++age)
      if (age < input.history->size() && !(*input.history)[age].released[i]) return false;
    for (std::size_t age = 0; age < kInRow; ++age)
      if (!(unexplained_v(parameters, input, i, age) > axis.response_margin_v)) return false;
    return true;
  });
}

/// The bridge cannot determine which of two writers is the supervisor.
bool second_writer(const LastLineParameters& /*parameters*/, const CheckInput& input) noexcept {
  return (*input.history)[0].observation.second_writer;
}

constexpr std::array kChecks{Check{Reason::second_writer, second_writer},
                             Check{Reason::command_stale, command_stale},
                             Check{Reason::command_not_finite, command_not_finite},
                             Check{Reason::command_range, command_range},
                             Check{Reason::command_rate, command_rate},
                             Check{Reason::not_homed, not_homed},
                             Check{Reason::encoder_jump, encoder_jump},
                             Check{Reason::lost_counts, lost_counts},
                             Check{Reason::position, position_fails},
                             Check{Reason::speed, overspeed},
                             Check{Reason::swing, swing_fails},
                             Check{Reason::braked_motion, braked_motion},
                             Check{Reason::encoder_frozen, encoder_frozen},
                             Check{Reason::drive_response, drive_response}};

}  // namespace

std::span<const Check> last_line_checks() noexcept { return kChecks; }

std::array<bool, kCounters> counters_in_doubt(Reason reason, const LastLineParameters& parameters,
                                              const CheckInput& input) noexcept {
  std::array<bool, kCounters> doubted{};
  for (std::size_t i = 0; i < kCounters; ++i) {
    if (reason == Reason::encoder_jump) doubted[i] = jumped(parameters, input, i);
    if (reason == Reason::lost_counts && i < kDrives) doubted[i] = counts_lost(parameters, input, i);
  }
  return doubted;
}

}  // namespace crane::bridge
