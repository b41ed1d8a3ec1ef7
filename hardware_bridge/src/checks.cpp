/// What the last line compares, one function per reason. Every comparison is written so that NaN fails.
#include <algorithm>
#include <cmath>

#include "crane/bridge/last_line.hpp"

namespace crane::bridge {
namespace {

constexpr double kRounding = 1e-9;

bool asks_for_motion(const CommandView& command, std::size_t axis) {
  return command.brake_release[axis] || command.drive_v[axis] != 0;
}

/// Time between two samples, however late one of them was; at least a hundredth of a period, so that nothing
/// is divided by zero.
double seconds(const LastLineParameters& parameters, const Moment& moment, std::size_t newer,
               std::size_t older) {
  constexpr double kShortest_periods = 0.01;
  const auto& history = *moment.history;
  const auto elapsed_ns = history[newer].seen.time_ns - history[older].seen.time_ns;
  return std::max(static_cast<double>(elapsed_ns) / 1e9, kShortest_periods * parameters.period_s);
}

/// Mean speed in the tick that ended `age` entries ago.
double speed(const LastLineParameters& parameters, const Moment& moment, std::size_t coordinate,
             std::size_t age = 0) {
  const auto& history = *moment.history;
  if (history.size() < age + 2) return 0;
  return (history[age].seen.coordinate[coordinate] - history[age + 1].seen.coordinate[coordinate]) /
         seconds(parameters, moment, age, age + 1);
}

template <class AxisFails>
bool any_axis(const LastLineParameters& parameters, const AxisFails& fails) {
  for (std::size_t i = 0; i < kDrives; ++i)
    if (parameters.axis[i].present && fails(i, parameters.axis[i])) return true;
  return false;
}

bool command_stale(const LastLineParameters& parameters, const Moment& moment) noexcept {
  if (moment.command == nullptr) return false;  // nothing has come yet, and nothing is given
  const auto tick = moment.command->tick;
  return tick >= moment.tick || moment.tick - 1 - tick >= parameters.stale_after_ticks;
}

bool command_not_finite(const LastLineParameters& /*parameters*/, const Moment& moment) noexcept {
  return moment.command != nullptr &&
         !std::all_of(moment.command->drive_v.begin(), moment.command->drive_v.end(),
                      [](double v) { return std::isfinite(v); });
}

bool command_range(const LastLineParameters& parameters, const Moment& moment) noexcept {
  if (moment.command == nullptr) return false;
  for (std::size_t i = 0; i < kDrives; ++i)
    if (std::isfinite(moment.command->drive_v[i]) &&
        std::abs(moment.command->drive_v[i]) > parameters.axis[i].volt_limit_v + kRounding)
      return true;
  return false;
}

/// Towards 0 V any step is allowed: that is how a crane is stopped.
bool command_rate(const LastLineParameters& parameters, const Moment& moment) noexcept {
  if (moment.command == nullptr) return false;
  const auto ticks =
      moment.command->tick > moment.before.tick ? moment.command->tick - moment.before.tick : 0;
  for (std::size_t i = 0; i < kDrives; ++i) {
    const double u = moment.command->drive_v[i], last = moment.before.drive_v[i];
    const bool towards_zero = u * last >= 0 && std::abs(u) <= std::abs(last);
    const double most =
        parameters.axis[i].volt_rate_limit_vps * parameters.period_s * static_cast<double>(ticks);
    if (std::isfinite(u) && !towards_zero && std::abs(u - last) > most + kRounding) return true;
  }
  return false;
}

/// What an axis may do whose position nobody knows: creep, and only to be homed. Its speed is the mean of
/// some ticks, because an axis that breaks loose from its friction leaps.
bool not_homed(const LastLineParameters& parameters, const Moment& moment) noexcept {
  constexpr double kBeyondCreeping = 3, kWindow_s = 0.05;
  if (moment.command == nullptr) return false;
  const auto& history = *moment.history;
  const auto ticks = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::llround(kWindow_s / parameters.period_s)), 1, History::kLength - 1);
  return any_axis(parameters, [&](std::size_t i, const AxisLine& axis) {
    if (!history[0].seen.unknown[i] || !asks_for_motion(*moment.command, i)) return false;
    if (!moment.command->homing[i] ||
        !(std::abs(moment.command->drive_v[i]) <= axis.homing.volt_limit_v + kRounding))
      return true;
    if (history.size() <= ticks) return false;
    const double way = history[0].seen.coordinate[i] - history[ticks].seen.coordinate[i];
    return !(std::abs(way) / seconds(parameters, moment, 0, ticks) <= kBeyondCreeping * axis.homing.speed);
  });
}

/// Beyond a hard limit, or too fast to stop before it: x +- (v t_brake + v^2 / 2a).
bool position(const LastLineParameters& parameters, const Moment& moment) noexcept {
  if (moment.command == nullptr) return false;
  return any_axis(parameters, [&](std::size_t i, const AxisLine& axis) {
    if (!asks_for_motion(*moment.command, i) || (*moment.history)[0].seen.unknown[i]) return false;
    const double x = (*moment.history)[0].seen.coordinate[i];
    const double v = speed(parameters, moment, i);
    const double way = std::abs(v) * axis.brake_close_time_s + v * v / (2 * axis.brake_deceleration);
    const double ahead = v > 0 ? x + way : x;
    const double behind = v < 0 ? x - way : x;
    return !(ahead <= axis.high_limit && behind >= axis.low_limit);
  });
}

bool overspeed(const LastLineParameters& parameters, const Moment& moment) noexcept {
  constexpr double kBeyondTheSupervisor = 1.1;
  return any_axis(parameters, [&](std::size_t i, const AxisLine& axis) {
    return !(std::abs(speed(parameters, moment, i)) <= kBeyondTheSupervisor * axis.max_speed);
  });
}

bool swing(const LastLineParameters& parameters, const Moment& moment) noexcept {
  if (moment.command == nullptr) return false;
  bool moving = false;
  for (std::size_t i = 0; i < kDrives; ++i) moving = moving || asks_for_motion(*moment.command, i);
  for (std::size_t i = 0; i < parameters.swing_present.size(); ++i)
    if (moving && parameters.swing_present[i] &&
        !(std::abs((*moment.history)[0].seen.coordinate[kDrives + i]) <= parameters.swing_limit_rad))
      return true;
  return false;
}

/// Farther within a tick than any motion goes.
bool jumped(const LastLineParameters& parameters, const Moment& moment, std::size_t counter) noexcept {
  constexpr double kBeyondMotion = 2;
  const bool drive = counter < kDrives;
  if (drive ? !parameters.axis[counter].present : !parameters.swing_present[counter - kDrives]) return false;
  const double fastest = drive ? parameters.axis[counter].max_speed : parameters.swing_rate_max_radps;
  return !(std::abs(speed(parameters, moment, counter)) <= kBeyondMotion * fastest);
}

bool encoder_jump(const LastLineParameters& parameters, const Moment& moment) noexcept {
  for (std::size_t i = 0; i < kCounters; ++i)
    if (jumped(parameters, moment, i)) return true;
  return false;
}

/// The mark that an axis has been homed by is seen elsewhere.
bool mark_disagrees(const AxisLine& axis, const Moment& moment, std::size_t i) noexcept {
  const auto& history = *moment.history;
  if (!axis.homes() || history.size() < 2 || history[1].seen.unknown[i]) return false;
  if (history[0].seen.mark[i] == history[1].seen.mark[i]) return false;
  const double now = history[0].seen.coordinate[i], before = history[1].seen.coordinate[i];
  const double low = std::min(now, before) - axis.homing.back_off;
  const double high = std::max(now, before) + axis.homing.back_off;
  return !(axis.homing.position >= low && axis.homing.position <= high);
}

/// A limit switch is a reference mark: where it closes, the axis is near its limit, or counts are lost.
bool counts_lost(const LastLineParameters& parameters, const Moment& moment, std::size_t i) noexcept {
  const AxisLine& axis = parameters.axis[i];
  const auto& seen = (*moment.history)[0].seen;
  if (!axis.present || seen.unknown[i]) return false;
  return (seen.limit_low[i] && seen.coordinate[i] > axis.low_limit + axis.soft_margin) ||
         (seen.limit_high[i] && seen.coordinate[i] < axis.high_limit - axis.soft_margin) ||
         mark_disagrees(axis, moment, i);
}

bool lost_counts(const LastLineParameters& parameters, const Moment& moment) noexcept {
  return any_axis(parameters, [&](std::size_t i, const AxisLine& /*axis*/) {
    return counts_lost(parameters, moment, i);
  });
}

bool braked_motion(const LastLineParameters& parameters, const Moment& moment) noexcept {
  return any_axis(parameters, [&](std::size_t i, const AxisLine& axis) {
    return moment.braked_at[i] &&
           std::abs((*moment.history)[0].seen.coordinate[i] - *moment.braked_at[i]) > axis.brake_slip;
  });
}

constexpr std::int64_t kFlicker_counts = 2;  // of an encoder on the edge of a count

bool stands(const History& history, std::size_t i, std::size_t newer, std::size_t older) {
  return std::abs(history[newer].seen.counts[i] - history[older].seen.counts[i]) <= kFlicker_counts;
}

/// Ticks until now in which the axis was free, was pushed to the side it is pushed to now, and was not seen
/// to move.
std::size_t pushed_in_vain(const History& history, std::size_t i) {
  const double side = history[0].seen.applied_v[i] > 0 ? 1 : -1;
  std::size_t ticks = 0;
  while (ticks + 1 < history.size() && history[ticks].free[i] &&
         side * history[ticks].seen.applied_v[i] > 0 && stands(history, i, 0, ticks + 1))
    ++ticks;
  return ticks;
}

/// The least way that an axis with a zero must have gone under the volts it got: from rest, with the smallest
/// gain, against 1.5 times its friction and the largest pull of the load. A healthy encoder shows far less
/// than kMustShow.
bool has_gone_unseen(const LastLineParameters& parameters, const AxisLine& axis, const History& history,
                     std::size_t i) {
  constexpr double kMustShow = 0.005;  // m, rad, m of cable: twenty times the play of a gear
  double way = 0, speed = 0;
  for (std::size_t age = pushed_in_vain(history, i); age-- > 0;) {
    const double net_v = std::max(std::abs(history[age].seen.applied_v[i]) - axis.certain_motion_v, 0.0);
    if (axis.lag_s > 0)
      speed += (axis.gain_low * net_v - speed) * std::min(parameters.period_s / axis.lag_s, 1.0);
    else
      speed += axis.gain_low * net_v * parameters.period_s;
    way += speed * parameters.period_s;
  }
  return way > kMustShow;
}

/// The drive pushes harder than any friction and load can hold, the brake is open, and nothing is counted:
/// the encoder is dead, or the brake has not opened.
bool encoder_frozen(const LastLineParameters& parameters, const Moment& moment) noexcept {
  constexpr double kWindow_s = 0.1;
  const auto window = static_cast<std::size_t>(std::llround(kWindow_s / parameters.period_s));
  const auto ticks = std::clamp<std::size_t>(window, 2, History::kLength - 1);
  const auto& history = *moment.history;
  return any_axis(parameters, [&](std::size_t i, const AxisLine& axis) {
    if (!history[0].seen.unknown[i]) return has_gone_unseen(parameters, axis, history, i);
    if (pushed_in_vain(history, i) < ticks) return false;
    for (std::size_t age = 0; age < ticks; ++age)
      if (std::abs(history[age].seen.applied_v[i]) < axis.creeping_motion_v) return false;
    return true;
  });
}

/// Volts by which an axis gains more speed than any command of the last ticks can explain. Friction and
/// brakes only take speed away, so that they need not be known; a pull of the load is within the margin.
double unexplained_v(const LastLineParameters& parameters, const Moment& moment, std::size_t i,
                     std::size_t age) {
  const auto ticks = [&parameters](double time_s, std::size_t most) {
    return std::clamp<std::size_t>(static_cast<std::size_t>(std::llround(time_s / parameters.period_s)), 2,
                                   most);
  };
  const std::size_t span = ticks(0.05, 14), remembered = ticks(0.12, 24);
  const auto& history = *moment.history;
  const AxisLine& axis = parameters.axis[i];
  if (history.size() < age + remembered + 2) return 0;
  const double v = speed(parameters, moment, i, age);
  const double side = v > 0 ? 1 : -1;
  // An axis that was going the other way has been stopped by anything, and gains from 0 on.
  const double before = std::max(side * speed(parameters, moment, i, age + span), 0.0);
  double gained = (std::abs(v) - before) / seconds(parameters, moment, age, age + span);
  double most_v = side * history[age].seen.applied_v[i];
  for (std::size_t k = 1; k < remembered; ++k)
    most_v = std::max(most_v, side * history[age + k].seen.applied_v[i]);
  if (axis.lag_s > 0) gained = gained * axis.lag_s + std::abs(v);  // what the drive's command would be
  if (!(gained > 0)) return 0;  // it may stand against a drive, by its friction
  return (gained - most_v * (most_v > 0 ? axis.gain_high : axis.gain_low)) / axis.gain_high;
}

/// An axis that moves under a brake which was told to close is the matter of braked_motion: what moves it
/// there is its load, and its drive has 0 V.
bool drive_response(const LastLineParameters& parameters, const Moment& moment) noexcept {
  constexpr double kMargin_v = 2.5;
  constexpr std::size_t kInRow = 3;
  return any_axis(parameters, [&](std::size_t i, const AxisLine& /*axis*/) {
    for (std::size_t age = 0; age < kInRow; ++age)
      if (age < moment.history->size() && !(*moment.history)[age].released[i]) return false;
    for (std::size_t age = 0; age < kInRow; ++age)
      if (!(unexplained_v(parameters, moment, i, age) > kMargin_v)) return false;
    return true;
  });
}

/// Nobody can tell which of two command writers is the supervisor.
bool second_writer(const LastLineParameters& /*parameters*/, const Moment& moment) noexcept {
  return (*moment.history)[0].seen.second_writer;
}

constexpr std::array kChecks{Check{Reason::second_writer, second_writer},
                             Check{Reason::command_stale, command_stale},
                             Check{Reason::command_not_finite, command_not_finite},
                             Check{Reason::command_range, command_range},
                             Check{Reason::command_rate, command_rate},
                             Check{Reason::not_homed, not_homed},
                             Check{Reason::encoder_jump, encoder_jump},
                             Check{Reason::lost_counts, lost_counts},
                             Check{Reason::position, position},
                             Check{Reason::speed, overspeed},
                             Check{Reason::swing, swing},
                             Check{Reason::braked_motion, braked_motion},
                             Check{Reason::encoder_frozen, encoder_frozen},
                             Check{Reason::drive_response, drive_response}};

}  // namespace

std::span<const Check> last_line_checks() noexcept { return kChecks; }

std::array<bool, kCounters> counters_in_doubt(Reason reason, const LastLineParameters& parameters,
                                              const Moment& moment) noexcept {
  std::array<bool, kCounters> doubted{};
  for (std::size_t i = 0; i < kCounters; ++i) {
    if (reason == Reason::encoder_jump) doubted[i] = jumped(parameters, moment, i);
    if (reason == Reason::lost_counts && i < kDrives) doubted[i] = counts_lost(parameters, moment, i);
  }
  return doubted;
}

}  // namespace crane::bridge
