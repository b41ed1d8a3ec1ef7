#include "controller.hpp"

#include <algorithm>
#include <numbers>

namespace mujoco_truth {
namespace {

constexpr double kMost_v = 10, kConverter_v = 20.0 / 8192;
/// The operator reverses the motion at this distance of the axis from the middle, as a share of its reach.
constexpr double kTurnRound = 0.7;

double smooth(double s) {  // minimum jerk, 0 to 1
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}
double smooth_rate(double s) { return s <= 0 || s >= 1 ? 0 : 30 * s * s * (1 - s) * (1 - s); }

}  // namespace

Driver::Driver(const Rig& rig, const Nuisance& nuisance, const RunPlan& plan)
    : rig_(rig), nuisance_(nuisance), run_(plan) {
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig.drive[i].there) {
      Chance chance(plan.seed, i == kTrolley ? "trolley plan" : "slew plan");
      plan_axis(i, chance);
    }
}

void Driver::plan_axis(std::size_t axis, Chance& chance) {
  const Drive& drive = rig_.drive[axis];
  Plan& plan = plan_[axis];
  plan.centre = (drive.low_m + drive.high_m) / 2;
  plan.reach = 0.38 * (drive.high_m - drive.low_m) * std::min(1.0, run_.amplitude);
  const double most_speed = axis == kTrolley ? 0.6 : 1.0;
  plan.speed = most_speed * std::min(2.0, run_.amplitude);
  double now = chance.uniform(0.5, 2), at = plan.centre;
  while (now < run_.duration_s) {
    const double to = plan.centre + plan.reach * chance.uniform(-1, 1);
    double takes = std::max(0.6, 1.9 * std::abs(to - at) / plan.speed);
    if (run_.experiment == Experiment::steps) takes = 0.02;
    if (run_.experiment == Experiment::sweep) takes = std::max(6.0, 4 * takes);
    plan.targets.push_back({now, takes, to});
    now += takes + chance.uniform(0.3, 3);
    at = to;
  }
  const double load_hz = std::sqrt(rig_.gravity_mps2 / run_.cable_m) / kTau;
  for (int k = 0; k < 3; ++k) {
    const double hz = (rig_.has_load() ? load_hz : 0.5) * chance.log_uniform(0.2, 2.5);
    plan.tones.push_back(
        {std::min(plan.reach / 3, plan.speed / (kTau * hz) / 2), hz, chance.uniform(0, kTau)});
  }
  for (double t = chance.uniform(0.3, 1.5); t < run_.duration_s;) {
    const double lasts = chance.uniform(0.3, 1.8);
    const double friction = std::max(drive.coulomb_pos_v, drive.coulomb_neg_v);
    plan.presses.push_back(
        {t, t + lasts, chance.sign() * (friction + run_.amplitude * chance.uniform(0.4, 2.2))});
    t += lasts + chance.uniform(0.2, 2);
  }
}

std::array<double, 2> Driver::reference(const Plan& plan, double time_s) const {
  if (run_.experiment == Experiment::free_swing) return {plan.centre, 0};
  if (run_.experiment == Experiment::sines) {
    std::array<double, 2> r{plan.centre, 0};
    const double fade = smooth(time_s / 3);
    for (const Tone& tone : plan.tones) {
      const double w = kTau * tone.hz;
      r[0] += fade * tone.amplitude * std::sin(w * time_s + tone.phase);
      r[1] += fade * tone.amplitude * w * std::cos(w * time_s + tone.phase);
    }
    return r;
  }
  std::array<double, 2> r{plan.centre, 0};
  for (const auto& [from, takes, to] : plan.targets) {
    if (time_s < from) break;
    const double s = (time_s - from) / takes;
    r = {r[0] + (to - r[0]) * smooth(s), (to - r[0]) * smooth_rate(s) / takes};
  }
  return r;
}

double Driver::follow(std::size_t axis, const Row& row, double speed, double swing_rate) {
  const Drive& drive = rig_.drive[axis];
  const Plan& plan = plan_[axis];
  const double w = nuisance_.bandwidth_radps, position = row.position[axis];
  if (run_.experiment == Experiment::free_swing) return 0;
  if (nuisance_.controller == Controller::operator_jog) {
    for (const auto& [from, to, volts] : plan.presses)
      if (row.time_s >= from && row.time_s < to) {
        const double off = (position - plan.centre) / std::max(1e-6, plan.reach);
        const double ramp = std::min(1.0, (row.time_s - from) / 0.15);
        return ramp * (std::abs(off) > kTurnRound ? -std::copysign(std::abs(volts), off) : volts);
      }
    return 0;
  }
  const auto [wanted, wanted_speed] = reference(plan, row.time_s);
  double volts = 0;
  if (nuisance_.controller == Controller::open_loop) {
    // Voltage that the stated model needs for the slow motion.
    volts = (wanted_speed >= 0 ? drive.viscous_pos_vspm : drive.viscous_neg_vspm) * wanted_speed +
            0.3 * w * w * (wanted - position) / drive.gain_mps2pv +
            1.2 * w * wanted_speed / drive.gain_mps2pv - 0.8 * w * speed / drive.gain_mps2pv;
  } else {
    volts = (w * w * (wanted - position) + 1.4 * w * (wanted_speed - speed)) / drive.gain_mps2pv;
  }
  if (nuisance_.controller != Controller::position_pd && std::abs(wanted_speed) > 0.01 * plan.speed)
    volts += 0.8 * (wanted_speed > 0 ? drive.coulomb_pos_v : -drive.coulomb_neg_v);
  if (nuisance_.anti_swing > 0 && rig_.has_load()) {
    const double toward = axis == kTrolley ? -1 : 1 / std::max(0.4, row.position[kTrolley]);
    volts += toward * nuisance_.anti_swing * run_.cable_m * 2 * swing_rate / drive.gain_mps2pv;
  }
  return volts;
}

std::array<double, kAxes> Driver::command(const Row& row) {
  const double dt = row.time_s - last_s_;
  if (last_s_ >= 0) {
    const double keep = std::exp(-dt / std::max(0.05, 3 / nuisance_.rate_hz));
    const auto filter = [&](double& rate, double now, double before) {
      rate = keep * rate + (1 - keep) * (now - before) / dt;
    };
    for (std::size_t i = 0; i < kAxes; ++i) filter(speed_[i], row.position[i], last_position_[i]);
    for (std::size_t i = 0; i < kSwings; ++i) filter(rate_[i], row.swing[i], last_swing_[i]);
  }
  last_s_ = row.time_s;
  last_position_ = row.position;
  last_swing_ = row.swing;
  std::array<double, kAxes> volts{};
  for (std::size_t i = 0; i < kAxes; ++i)
    if (rig_.drive[i].there) {
      const double wanted = std::clamp(follow(i, row, speed_[i], rate_[i]), -kMost_v, kMost_v);
      volts[i] = std::round(wanted / kConverter_v) * kConverter_v;
    }
  return volts;
}

}  // namespace mujoco_truth
