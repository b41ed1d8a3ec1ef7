#include "experiment/safe_run.hpp"

#include <algorithm>
#include <cmath>

namespace crane::diagnosis {
namespace {

using plant::Axis;
using plant::kHoist;
using plant::kSlew;
using plant::kTrolley;
using plant::State;

constexpr double kLoopStep_s = 0.001;
constexpr double kLoop_radps = 6;     // natural frequency of the position loop, critically damped
constexpr double kVoltShare = 0.9;    // of volt_limit_v of the drive
constexpr double kSwingShare = 0.95;  // of swing_limit_rad, above which the supervisor stops the crane

double& rate(State& state, Axis axis) { return axis == kTrolley ? state.trolley_mps : state.slew_radps; }

/// The crane under its position loop, tick by tick.
class FollowedMotion {
 public:
  FollowedMotion(const configuration::Rig& rig, const Crane& crane, const SafeMotion& motion)
      : rig_(rig), motion_(motion), model_(crane.parameters, crane.terms, rig.period_s) {
    state_.trolley_m = motion.start[kTrolley];
    state_.slew_rad = motion.start[kSlew];
    state_.cable_m = motion.start[kHoist];
    state_.radial_rad = motion.swing_radial_rad;
    state_.tangential_rad = motion.swing_tangential_rad;
    actuation_.locks.axis = {!rig.drives[kTrolley].present, !rig.drives[kSlew].present, true};
    actuation_.locks.radial = !rig.measures(plant::kSwingRadial);
    actuation_.locks.tangential = !rig.measures(plant::kSwingTangential);
  }

  [[nodiscard]] const State& state() const { return state_; }

  /// Applies the voltage that the previous tick has computed. @return this voltage
  plant::PerAxis tick(double time_s) {
    const plant::PerAxis command = next_;
    for (const Axis axis : {kTrolley, kSlew})
      if (rig_.drives[axis].present) next_[axis] = wanted_v(axis, time_s);
    actuation_.drive_v = model_.drive_voltage(command);
    const int steps = std::max(1, static_cast<int>(std::ceil(rig_.period_s / kLoopStep_s - 1e-9)));
    for (int i = 0; i < steps; ++i) step(rig_.period_s / steps);
    return command;
  }

  [[nodiscard]] bool within_limits() const {
    for (const Axis axis : {kTrolley, kSlew}) {
      const configuration::Drive& drive = rig_.drives[axis];
      const double at = plant::position(state_, axis);
      if (drive.present && !(at >= drive.low_limit && at <= drive.high_limit)) return false;
    }
    const double swing = kSwingShare * rig_.limits.swing_limit_rad;
    return std::abs(state_.radial_rad) < swing && std::abs(state_.tangential_rad) < swing;
  }

 private:
  [[nodiscard]] double wanted_v(Axis axis, double time_s) {
    const control::AxisReference wanted = motion_.reference(axis, time_s);
    State moving = state_;
    rate(moving, axis) = wanted.speed;
    const double error = wanted.position - plant::position(state_, axis);
    const double error_rate = wanted.speed - plant::speed(state_, axis);
    const double gain = axis == kTrolley ? rig_.plant.trolley_gain_mps2pv : rig_.plant.slew_gain_radps2pv;
    const double moving_v =
        (wanted.acceleration + kLoop_radps * kLoop_radps * error + 2 * kLoop_radps * error_rate) / gain;
    const double volt = moving_v + model_.friction_v(moving, moving_v, axis);
    const double most = kVoltShare * rig_.drives[axis].volt_limit_v;
    return std::clamp(volt, -most, most);
  }

  /// Semi-implicit Euler method. The friction is steep near standstill and is therefore linearised.
  void step(double h) {
    constexpr double kSmall = 1e-4;
    const plant::PerAxis friction = model_.friction_v(state_, actuation_.drive_v);
    plant::InnerAccelerations inner{};
    const plant::Accelerations a = model_.accelerations(state_, actuation_, friction, inner_, inner);
    plant::PerAxis drive{a.trolley_mps2, a.slew_radps2, 0};
    State faster = state_;
    faster.trolley_mps += kSmall, faster.slew_radps += kSmall;
    const plant::PerAxis more = model_.friction_v(faster, actuation_.drive_v);
    const plant::PerAxis gain{rig_.plant.trolley_gain_mps2pv, rig_.plant.slew_gain_radps2pv, 0};
    for (const Axis axis : {kTrolley, kSlew})
      drive[axis] /= 1 + h * gain[axis] * std::max(0.0, more[axis] - friction[axis]) / kSmall;
    state_.trolley_mps += h * drive[kTrolley];
    state_.slew_radps += h * drive[kSlew];
    state_.radial_radps += h * a.radial_radps2;
    state_.tangential_radps += h * a.tangential_radps2;
    state_.trolley_m += h * state_.trolley_mps;
    state_.slew_rad += h * state_.slew_radps;
    state_.radial_rad += h * state_.radial_radps;
    state_.tangential_rad += h * state_.tangential_radps;
    for (std::size_t i = 0; i < model_.inner_coordinates(); ++i) {
      inner_[i].rate += h * inner[i];
      inner_[i].position += h * inner_[i].rate;
    }
  }

  const configuration::Rig& rig_;
  const SafeMotion& motion_;
  plant::Model model_;
  State state_;
  plant::InnerState inner_{};
  plant::Actuation actuation_;
  plant::PerAxis next_{};
};

}  // namespace

std::optional<PreparedRun> safe_run(const configuration::Rig& rig, const Crane& crane,
                                    const SafeMotion& motion) {
  FollowedMotion followed(rig, crane, motion);
  Run run;
  run.name = motion.name;
  run.period_s = rig.period_s;
  const auto rows = static_cast<std::size_t>(motion.duration_s / rig.period_s);
  for (std::size_t k = 0; k < rows; ++k) {
    run.command_v.push_back(followed.tick(static_cast<double>(k) * rig.period_s));
    if (!followed.within_limits()) return std::nullopt;
  }
  run.cable_m.assign(rows, motion.start[kHoist]);
  const std::array<bool, kOutputs> has{rig.drives[kTrolley].present, rig.drives[kSlew].present,
                                       rig.measures(plant::kSwingRadial),
                                       rig.measures(plant::kSwingTangential)};
  for (std::size_t i = 0; i < kOutputs; ++i)
    if (has[i]) run.measured[i].assign(rows, 0.0);
  PreparedRun prepared = prepare(run, rig);
  const std::array<double, kOutputs> start{motion.start[kTrolley], motion.start[kSlew],
                                           motion.swing_radial_rad, motion.swing_tangential_rad};
  const auto outputs = simulated_outputs(prepared, Part::whole);
  std::vector<double> begin, reported(outputs.size() * rows);
  for (const Output output : outputs) begin.insert(begin.end(), {start[output], 0.0});
  Replay(prepared, crane).run(Part::whole, 0, rows, begin, reported);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto first = reported.begin() + static_cast<std::ptrdiff_t>(i * rows);
    run.measured[outputs[i]].assign(first, first + static_cast<std::ptrdiff_t>(rows));
  }
  if (!std::all_of(reported.begin(), reported.end(), [](double value) { return std::isfinite(value); }))
    return std::nullopt;
  return prepare(std::move(run), rig);
}

}  // namespace crane::diagnosis
