#include "trajectory_planner/motion.hpp"

#include <algorithm>
#include <cmath>

#include "crane/plant/pendulum.hpp"

namespace crane::services {

using control::kAxes;

namespace {

control::Shaping shaping_of(control::ReferenceShape shape, control::Shaping of_rig_file) {
  switch (shape) {
    case control::ReferenceShape::zv:
    case control::ReferenceShape::time_optimal:  // this profile is used for moves without a plan
      return control::Shaping::zv;
    case control::ReferenceShape::zvd:
      return control::Shaping::zvd;
    case control::ReferenceShape::ei:
      return control::Shaping::ei;
    case control::ReferenceShape::step:
    case control::ReferenceShape::bang_coast_bang:
      break;
  }
  return of_rig_file;
}

}  // namespace

Motion::Motion(const configuration::Rig& rig, control::ReferenceShape shape)
    : rig_{rig}, shape_{shape}, shaping_{shaping_of(shape, rig.planning.shaping)} {}

void Motion::begin_at(std::uint64_t tick) noexcept {
  start_tick_ = tick;
  slowing_.reset();
}

double Motion::time_s(std::uint64_t tick) const noexcept {
  const double passed_s = tick > start_tick_ ? static_cast<double>(tick - start_tick_) * rig_.period_s : 0;
  if (!slowing_) return passed_s;
  const double slow_s = std::clamp(passed_s - slowing_->begin_s, 0.0, slowing_->duration_s);
  return std::min(passed_s, slowing_->begin_s) + slow_s - slow_s * slow_s / (2 * slowing_->duration_s);
}

void Motion::follow(const control::Measurement& measured, std::uint64_t tick) noexcept {
  Profiles rest;
  for (std::size_t i = 0; i < kAxes; ++i)
    rest.trajectory[i] = control::step_profile(measured.position[i], measured.position[i]);
  active_ = rest;
  begin_at(tick);
}

control::AxisProfile Motion::planned(std::size_t axis, double start, double target,
                                     const ProfileLimits& profile) const {
  if ((profile.steps && axis != control::kHoist) || target == start)
    return control::step_profile(start, target);
  const auto& drive = rig_.drives[axis];
  control::AxisLimits limits{
      .speed = axis == control::kSlew ? profile.slew_speed_radps : drive.reference_speed,
      .acceleration = drive.reference_acceleration};
  if (rig_.planning.limits_jerk) limits.jerk = drive.reference_jerk;
  return control::limited_profile(start, target, limits);
}

double Motion::usable_cable_m(double cable_m) const noexcept {
  return std::clamp(cable_m, rig_.design.shortest_cable_length_m, rig_.design.longest_cable_length_m);
}

control::Shaper Motion::shaper(control::Shaping shaping, double cable_m) const {
  return {shaping, plant::swing_period_s(rig_.design.crane.gravity_mps2, usable_cable_m(cable_m))};
}

void Motion::start(const MoveTarget& move, std::uint64_t tick) {
  const auto now = at(tick);
  const ProfileLimits limits = profile_limits(rig_, shape_, now, move);
  Profiles next;
  for (std::size_t i = 0; i < kAxes; ++i)
    next.trajectory[i] =
        planned(i, now[i].position, move.selected[i] ? move.target[i] : now[i].position, limits);
  next.trajectory = control::synchronised(next.trajectory);
  const bool swings =
      next.trajectory[control::kTrolley].duration_s() > 0 || next.trajectory[control::kSlew].duration_s() > 0;
  const auto& cable = next.trajectory[control::kHoist];  // shaped for the mean length of the move
  if (swings) next.shaper = shaper(shaping_, (cable.start + cable.target) / 2);
  active_ = next;
  begin_at(tick);
}

std::optional<control::PlanProblem> Motion::plan_for(const MoveTarget& move,
                                                     std::uint64_t tick) const noexcept {
  if (shape_ != control::ReferenceShape::time_optimal) return std::nullopt;
  constexpr double kRoom = 1e-3;       // m, rad: extends the limits beyond a start or target at a limit
  constexpr double kSpeedShare = 0.9;  // share of max_speed, above which the supervisor stops the crane
  const auto now = at(tick);
  control::PlanProblem problem;
  problem.cable_m = now[control::kHoist].position;
  for (const auto& axis : now)
    if (axis.speed != 0) return std::nullopt;
  if (move.selected[control::kHoist] && move.target[control::kHoist] != problem.cable_m) return std::nullopt;
  problem.limits.swing_rad = rig_.planning.planned_swing_rad;
  for (std::size_t i : {control::kTrolley, control::kSlew}) {
    const auto& drive = rig_.drives[i];
    problem.from[i] = now[i].position;
    problem.to[i] = move.selected[i] ? move.target[i] : now[i].position;
    if (!drive.present) continue;
    problem.limits.volts[i] = rig_.planning.planned_volt_share * drive.volt_limit_v;
    problem.limits.speed[i] = kSpeedShare * drive.max_speed;
    problem.limits.low[i] =
        std::min({drive.low_limit + drive.soft_margin, problem.from[i] - kRoom, problem.to[i] - kRoom});
    problem.limits.high[i] =
        std::max({drive.high_limit - drive.soft_margin, problem.from[i] + kRoom, problem.to[i] + kRoom});
  }
  if (problem.from == problem.to) return std::nullopt;
  return problem;
}

void Motion::start(const control::PlanProblem& problem, const control::Plan& plan,
                   std::uint64_t tick) noexcept {
  active_ = Planned{&rig_.design, problem, plan};
  begin_at(tick);
}

void Motion::excite(const control::Excitation& excitation, std::uint64_t tick) {
  const auto now = at(tick);
  Profiles next{.trajectory = {}, .shaper = {}, .excitation = excitation};
  for (std::size_t i = 0; i < kAxes; ++i)
    next.trajectory[i] = control::step_profile(now[i].position, now[i].position);
  active_ = next;
  begin_at(tick);
}

void Motion::follow_homing_speed(const std::array<double, kAxes>& speed, const control::Measurement& measured,
                                 std::uint64_t tick) noexcept {
  const auto* creeping = std::get_if<Creeping>(&active_);
  if (creeping != nullptr && creeping->speed == speed) return;
  Creeping next{.speed = speed};
  const auto now = at(tick);
  for (std::size_t i = 0; i < kAxes; ++i)
    next.start[i] = speed[i] != 0 ? measured.position[i] : now[i].position;
  active_ = next;
  begin_at(tick);
}

void Motion::stop(const control::Measurement& measured, std::uint64_t tick) noexcept {
  Braking braking;
  for (std::size_t i = 0; i < kAxes; ++i)
    braking.axis[i] = {.start = measured.position[i],
                       .speed = measured.speed[i],
                       .deceleration = std::max(rig_.drives[i].reference_acceleration, 1e-3)};
  active_ = braking;
  begin_at(tick);
}

void Motion::jog(const std::array<bool, kAxes>& selected, std::uint64_t tick) noexcept {
  const auto now = at(tick);
  control::StickLimits limits;
  // ZVD replaces EI, whose residual swing would move the trolley beyond the limits of the stick.
  const bool robust = shaping_ == control::Shaping::zvd || shaping_ == control::Shaping::ei;
  limits.shaping = robust ? control::Shaping::zvd : control::Shaping::zv;
  if (!rig_.carries_load()) limits.shaping = control::Shaping::none;
  limits.period_s = rig_.period_s;
  limits.gravity_mps2 = rig_.design.crane.gravity_mps2;
  limits.longest_cable_m = usable_cable_m(now[control::kHoist].position);
  for (std::size_t i = 0; i < kAxes; ++i) {
    const auto& drive = rig_.drives[i];
    if (!drive.present) continue;
    const bool compensates = i == control::kTrolley && selected[control::kSlew];
    limits.axis[i] = {.speed = selected[i] || compensates ? drive.reference_speed : 0,
                      .acceleration = drive.reference_acceleration,
                      .low = drive.low_limit + drive.soft_margin,
                      .high = drive.high_limit - drive.soft_margin};
  }
  if (limits.axis[control::kHoist].speed > 0)
    limits.longest_cable_m = std::max(limits.longest_cable_m, limits.axis[control::kHoist].high);
  auto& stick = active_.emplace<Stick>();  // in place: too large for the stack of a real-time thread
  stick.limits = limits;
  control::begin(limits, now, stick.memory);
  stick.reference = now;
  stick.tick = tick;
  begin_at(tick);
}

void Motion::drive(const std::array<double, kAxes>& deflection, std::uint64_t tick) noexcept {
  auto* stick = std::get_if<Stick>(&active_);
  if (stick == nullptr) return;
  constexpr std::uint64_t kMostTicks = 100;  // the supervisor stops the crane before a gap becomes longer
  if (tick > stick->tick + kMostTicks) stick->tick = tick - kMostTicks;
  std::array<double, kAxes> wanted{};
  for (std::size_t i = 0; i < kAxes; ++i) wanted[i] = deflection[i] * stick->memory.limits[i].speed;
  for (; stick->tick < tick; ++stick->tick) {
    stick->reference = control::step(stick->limits, wanted, stick->memory);
    stick->reference.feed_forward_v = control::feed_forward(rig_.design, stick->limits, stick->memory);
  }
  if (!control::at_rest(stick->memory)) begin_at(tick);  // arrived() waits from the end of the motion on
}

control::Reference Motion::on_path(std::uint64_t tick) const noexcept {
  return std::visit([time_s = time_s(tick)](const auto& motion) { return motion.at(time_s); }, active_);
}

bool Motion::reference_rests(std::uint64_t tick) const noexcept {
  const auto* stick = std::get_if<Stick>(&active_);
  if (stick != nullptr && !control::at_rest(stick->memory)) return false;
  return std::ranges::all_of(at(tick), [](const auto& axis) { return axis.speed == 0; });
}

bool Motion::is_near(const control::Measurement& measured, std::uint64_t tick) const noexcept {
  constexpr double kBand = 0.01;  // m, rad
  const auto reference = at(tick);
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig_.drives[i].present && std::abs(measured.position[i] - reference[i].position) > kBand)
      return false;
  return true;
}

bool Motion::arrived(const control::Measurement& measured, std::uint64_t tick) const noexcept {
  constexpr double kSlow = 0.01;     // largest speed, m/s, rad/s
  constexpr double kLongest_s = 20;  // longest wait; friction may hold an axis outside the band
  const auto* stick = std::get_if<Stick>(&active_);
  if (stick != nullptr && !control::at_rest(stick->memory)) return false;
  const double end_s = std::visit([](const auto& motion) { return motion.duration_s(); }, active_);
  if (time_s(tick) > end_s + kLongest_s) return true;
  const auto reference = at(tick);
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig_.drives[i].present && (reference[i].speed != 0 || std::abs(measured.speed[i]) > kSlow))
      return false;
  return time_s(tick) >= end_s && is_near(measured, tick);
}

}  // namespace crane::services
