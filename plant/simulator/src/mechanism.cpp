#include "mechanism.hpp"

#include <cmath>
#include <stdexcept>

namespace crane::simulator {
namespace {

using plant::Axis;
using plant::kAxes;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;

/// Largest speed that counts as standstill with a closed brake, m/s or rad/s: the brake stops the axis in
/// less than a microsecond.
constexpr double kStandstill = 1e-6;
/// Largest number of events of one run(). More events indicate an invalid state.
constexpr int kMostEvents = 1000;

plant::State with_position(const plant::State& state, Axis axis, double value) {
  plant::StateArray values = plant::to_array(state);
  values[plant::kPositionIndex[axis]] = value;
  return plant::to_state(values);
}

const SimulatedRig& checked(const SimulatedRig& rig) {
  std::string text;
  for (const std::string& problem : rig.problems()) text += (text.empty() ? "" : "\n") + problem;
  if (!text.empty()) throw std::invalid_argument(text);
  return rig;
}

}  // namespace

Mechanism::Mechanism(const SimulatedRig& rig, const Tolerances& tolerances)
    : drives_(checked(rig).drives),
      model_(rig.parameters, rig.terms, rig.period_s),
      integrator_(model_, tolerances, rig.integrator),
      state_(rig.start) {
  for (std::size_t i = 0; i < kAxes; ++i) absent_.axis[i] = !drives_[i].present;
  absent_.radial = !rig.radial_swing || model_.parameters().load_mass_kg == 0;
  absent_.tangential = !rig.tangential_swing || model_.parameters().load_mass_kg == 0;
  if (absent_.axis[kTrolley]) state_.trolley_mps = 0;
  if (absent_.axis[kSlew]) state_.slew_radps = 0;
  if (absent_.axis[kHoist]) state_.cable_mps = 0;
  if (absent_.radial) state_.radial_radps = 0;
  if (absent_.tangential) state_.tangential_radps = 0;
}

void Mechanism::begin_tick(const plant::PerAxis& board_v) noexcept {
  plant::PerAxis command_v{};
  for (std::size_t i = 0; i < kAxes; ++i) command_v[i] = drives_[i].sign * board_v[i];
  drive_v_ = model_.drive_voltage(command_v);
  model_.begin_tick();
}

void Mechanism::kick(double radial_radps, double tangential_radps) noexcept {
  if (!absent_.radial) state_.radial_radps += radial_radps;
  if (!absent_.tangential) state_.tangential_radps += tangential_radps;
}

void Mechanism::run(double seconds) {
  double left_s = seconds;
  for (int events = 0; left_s > 0; ++events) {
    if (events > kMostEvents)
      throw std::runtime_error("simulated rig: brakes and end stops do not come to rest");
    const Situation now = situation();
    const Advance advance =
        integrator_.advance(state_, inner_, now.actuation, left_s, now.watch, first_step_s_);
    first_step_s_ = advance.next_first_step_s;
    left_s -= advance.elapsed_s;
    if (!advance.event) return;
    const Axis axis = advance.event->axis;
    if (advance.event->kind != EventKind::standstill) {
      const bool low = advance.event->kind == EventKind::low;
      state_ = with_position(state_, axis, low ? drives_[axis].low_stop : drives_[axis].high_stop);
    }
    stop(axis, now.actuation.locks);
  }
}

void Mechanism::stop(Axis axis, const plant::Locks& locks) {
  state_ = plant::stop_dead(model_.parameters(), state_, axis, locks);
}

/// Actuation at the present time (locked axes, brake forces), and the events to watch for.
Mechanism::Situation Mechanism::situation() {
  Situation now;
  now.actuation.drive_v = drive_v_;
  now.actuation.locks = absent_;
  for (const Axis axis : {kTrolley, kSlew, kHoist}) {
    if (!absent_.axis[axis] && brake_closed_[axis]) brake(axis, now);
  }
  for (const Axis axis : {kTrolley, kSlew, kHoist}) {
    if (!now.actuation.locks.axis[axis]) meet_stop(axis, now);
  }
  return now;
}

void Mechanism::brake(Axis axis, Situation& now) {
  const double v = plant::speed(state_, axis);
  if (std::abs(v) > kStandstill) {
    now.actuation.brake_effort[axis] = std::copysign(brake_effort(axis), -v);
    now.watch.standstill[axis] = true;
    return;
  }
  if (v != 0) stop(axis, now.actuation.locks);
  now.actuation.locks.axis[axis] = true;
}

double Mechanism::brake_effort(Axis axis) const {
  const plant::Parameters& p = model_.parameters();
  const double deceleration = drives_[axis].brake_deceleration;
  if (axis == kTrolley) return deceleration * (p.trolley_inertia_kg + p.load_mass_kg);
  if (axis == kHoist) return deceleration;
  const double moving_kg = p.trolley_mass_kg + p.load_mass_kg;
  return deceleration * (p.jib_inertia_kgm2 + moving_kg * state_.trolley_m * state_.trolley_m);
}

void Mechanism::meet_stop(Axis axis, Situation& now) {
  const SimulatedDrive& drive = drives_[axis];
  const double at = plant::position(state_, axis);
  int side = 0;
  if (at <= drive.low_stop) side = -1;
  if (at >= drive.high_stop) side = 1;
  if (side == 0) {
    now.watch.low[axis] = drive.low_stop;
    now.watch.high[axis] = drive.high_stop;
    return;
  }
  if (plant::speed(state_, axis) * side > 0) stop(axis, now.actuation.locks);
  if (plant::speed(state_, axis) != 0) return;  // the axis moves inwards
  plant::InnerAccelerations own{};
  const plant::Accelerations free = model_.accelerations(state_, now.actuation, inner_, own);
  const plant::PerAxis push{free.trolley_mps2, free.slew_radps2, free.cable_mps2};
  if (push[axis] * side < 0) return;
  state_ = with_position(state_, axis, side < 0 ? drive.low_stop : drive.high_stop);
  now.actuation.locks.axis[axis] = true;
}

}  // namespace crane::simulator
