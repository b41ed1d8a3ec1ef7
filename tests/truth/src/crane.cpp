#include "crane.hpp"

#include <algorithm>
#include <cmath>

namespace truth {
namespace {

constexpr double kConverterStep_v = 20.0 / 8192;
constexpr double kPivotPresliding_rad = 3e-4;

}  // namespace

Crane::Crane(const Physics& physics, const Disturbance& disturbance, const Start& start, std::uint64_t seed,
             const std::string& run)
    : physics_(physics),
      mechanics_(physics),
      disturbance_(disturbance),
      noise_(seed, run + " noise"),
      slips_(seed, run + " slips") {
  now_.q[kMotorX] = now_.q[kCarriage] = start.trolley_m;
  now_.q[kMotorSlew] = now_.q[kJib] = start.slew_rad;
  now_.q[kRadial] = now_.q[kRadial2] = start.radial_rad;
  now_.q[kTangential] = now_.q[kTangential2] = start.tangential_rad;
  const double length = physics.cable_m + physics.cable_error_m;
  now_.q[kCable] = length;
  if (physics.cable_stiffness_n > 0)
    now_.q[kCable] = length * (1 + physics.load_kg * physics.gravity_mps2 / physics.cable_stiffness_n);

  const std::array<double, 6> rms{disturbance.drive_v, disturbance.drive_v, disturbance.load_n,
                                  disturbance.load_n,  physics.gust_mps,    physics.gust_mps};
  const std::array<std::string, 6> name{"trolley", "slew", "wind x", "wind y", "air x", "air y"};
  for (std::size_t i = 0; i < rms.size(); ++i) {
    const double correlation_s = i < 4 ? disturbance.correlation_s : 1.0;
    coloured_.emplace_back(Random{seed, run + name[i]}, rms[i], correlation_s, kTick_s);
    after_[i] = coloured_.back().value();
  }
  Random brake{seed, run + " brake"};
  for (double t = brake.uniform(1, 4); t < 120; t += brake.uniform(2, 6)) {
    dragging_.push_back({t, t + brake.uniform(0.4, 1.2)});
    t = dragging_.back().to_s;
  }
  for (std::size_t i = 0; i < kDrives; ++i) {
    const Drive& d = physics.drive[i];
    const double level = 0.5 * (d.coulomb_v[0] + d.coulomb_v[1]);
    const bool any = level > 0 || d.stribeck_v > 0 || d.bump_v > 0 || d.sticking_v > 0;
    if (any) drive_bristles_[i] = Bristles::of(std::max(level, 0.5), d.presliding, d.gain);
    const double inertia = i == 0 ? physics.carriage_kg : 0.65 * physics.jib_kgm2;
    if (d.gap_margin > 0) driven_bristles_[i] = Bristles::of(d.gap_margin, d.presliding, 1 / inertia);
    if (physics.pivot_coulomb_nm > 0)
      pivot_bristles_[i] = Bristles::of(physics.pivot_coulomb_nm, kPivotPresliding_rad,
                                        1 / (physics.load_kg * length * length));
  }
  remember();
}

Volts Crane::converted(const Volts& command_v) const {
  Volts out{};
  for (std::size_t i = 0; i < kDrives; ++i) {
    const double v = std::clamp(command_v[i], -10.0, 10.0 - kConverterStep_v);
    out[i] = (disturbance_.quantised ? std::round(v / kConverterStep_v) * kConverterStep_v : v) +
             0.0;  // avoids -0
  }
  return out;
}

/// Command at `time_s` with the delay of each axis; 0 before the start.
Volts Crane::delayed(double time_s) const {
  Volts v{};
  for (std::size_t i = 0; i < kDrives; ++i) {
    const double tick = std::floor((time_s - physics_.drive[i].delay_s) / kTick_s);
    if (tick >= 0) v[i] = commands_v_[std::min(static_cast<std::size_t>(tick), commands_v_.size() - 1)][i];
  }
  return v;
}

Crane::Moving Crane::stepped(const Moving& at, double span_s, const Moving& slope) {
  Moving next = at;
  for (std::size_t i = 0; i < kCoordinates; ++i) {
    next.q[i] += span_s * slope.q[i];
    next.rate[i] += span_s * slope.rate[i];
  }
  for (std::size_t i = 0; i < kDrives; ++i) {
    next.lag_1[i] += span_s * slope.lag_1[i];
    next.lag_2[i] += span_s * slope.lag_2[i];
    next.hysteresis[i] += span_s * slope.hysteresis[i];
  }
  return next;
}

void Crane::advance_bristles(double span_s) {
  for (std::size_t i = 0; i < kDrives; ++i) {
    const std::size_t motor = i == 0 ? kMotorX : kMotorSlew, driven = i == 0 ? kCarriage : kJib;
    const std::size_t swing = i == 0 ? kRadial : kTangential;
    const double speed = now_.rate[motor];
    drive_bristles_[i].advance(speed, friction_level(i, now_.q[motor], speed, time_s_), span_s);
    driven_bristles_[i].advance(now_.rate[driven], physics_.drive[i].gap_margin, span_s);
    pivot_bristles_[i].advance(now_.rate[swing], physics_.pivot_coulomb_nm, span_s);
  }
}

/// Strang splitting: half a step of the bristles, a whole step of the motion, half a step of the bristles.
void Crane::run(double span_s, const Volts& input_v) {
  const int steps = std::max(1, static_cast<int>(std::lround(std::ceil(span_s / kStep_s - 1e-9))));
  const double h = span_s / steps;
  for (int i = 0; i < steps; ++i) {
    advance_bristles(0.5 * h);
    const Moving k1 = slope(now_, input_v, time_s_);
    const Moving k2 = slope(stepped(now_, 0.5 * h, k1), input_v, time_s_ + 0.5 * h);
    const Moving k3 = slope(stepped(now_, 0.5 * h, k2), input_v, time_s_ + 0.5 * h);
    const Moving k4 = slope(stepped(now_, h, k3), input_v, time_s_ + h);
    now_ = stepped(stepped(stepped(stepped(now_, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
    time_s_ += h;
    advance_bristles(0.5 * h);
    remember();
  }
}

/// Times inside this tick at which a delayed command changes, and the end of the tick.
std::vector<double> Crane::edges(double end_s) const {
  std::vector<double> at;
  for (const Drive& d : physics_.drive) {
    if (d.delay_s <= 0) continue;
    const double edge = tick_start_s_ + std::fmod(d.delay_s, kTick_s);
    if (edge > tick_start_s_ + 1e-9 && edge < end_s - 1e-9) at.push_back(edge);
  }
  at.push_back(end_s);
  std::sort(at.begin(), at.end());
  return at;
}

void Crane::advance(const Volts& command_v) {
  commands_v_.push_back(command_v);
  tick_start_s_ = static_cast<double>(commands_v_.size() - 1) * kTick_s;
  time_s_ = tick_start_s_;
  before_ = after_;
  for (std::size_t i = 0; i < coloured_.size(); ++i) after_[i] = coloured_[i].step();
  const double end_s = static_cast<double>(commands_v_.size()) * kTick_s;
  for (const double edge : edges(end_s)) {
    const Volts command = delayed(0.5 * (time_s_ + edge));
    Volts input{};
    for (std::size_t i = 0; i < kDrives; ++i) input[i] = amplifier(i, command, time_s_);
    if (edge > time_s_) run(edge - time_s_, input);
    time_s_ = edge;
  }
  slip();
}

Crane Crane::without_effects(Physics nominal) const {
  Crane other = *this;
  nominal.cable_m = physics_.cable_m;
  other.physics_ = nominal;
  other.mechanics_ = Mechanics{nominal};
  other.past_.clear();
  return other;
}

Crane Crane::undisturbed() const {
  Crane other = *this;
  for (std::size_t i = 0; i < other.coloured_.size(); ++i) {
    other.coloured_[i].silence();
    other.after_[i] = 0;
  }
  return other;
}

double Crane::energy_j() const {
  double energy = mechanics_.energy_j(now_.q, now_.rate);
  if (mechanics_.moves(kCable)) {
    const double natural = physics_.cable_m + physics_.cable_error_m, longer = now_.q[kCable] - natural;
    energy += 0.5 * physics_.cable_stiffness_n / natural * longer * longer;
  }
  return energy;
}

}  // namespace truth
