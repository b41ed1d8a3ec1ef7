#include "crane.hpp"

#include <algorithm>
#include <cmath>

namespace truth {
namespace {

constexpr double kConverterStep_v = 20.0 / 8192;
constexpr std::array<double, kDrives> kContactStiffness{1e5, 4e4};  // N/m, N m/rad
constexpr double kContactDamping = 0.15, kElasticDamping = 0.03;    // share of the critical one
constexpr double kPivotPresliding_rad = 3e-4;
constexpr double kSlipsPerSecond = 2;
constexpr double kHistory_s = 0.6;

double along(double share, double from, double to) { return from + share * (to - from); }

double sign(double value) { return value < 0 ? -1 : 1; }

/// No output below the threshold, a rounded corner, then the input less the threshold.
double dead_zone(double volts, double threshold_v) {
  const double width = volts < 0 ? 1.1 * threshold_v : threshold_v;
  if (width <= 0) return volts;
  const double beyond = std::abs(volts) - width, corner = 0.1 * width;
  return sign(volts) * corner * std::log1p(std::exp(std::min(beyond / corner, 600.0)));
}

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
    out[i] =
        (disturbance_.quantised ? std::round(v / kConverterStep_v) * kConverterStep_v : v) + 0.0;  // no -0
  }
  return out;
}

/// Command of the moment `time_s`, each axis with its delay; 0 before the start.
Volts Crane::delayed(double time_s) const {
  Volts v{};
  for (std::size_t i = 0; i < kDrives; ++i) {
    const double tick = std::floor((time_s - physics_.drive[i].delay_s) / kTick_s);
    if (tick >= 0) v[i] = commands_v_[std::min(static_cast<std::size_t>(tick), commands_v_.size() - 1)][i];
  }
  return v;
}

double Crane::amplifier(std::size_t axis, const Volts& command_v, double time_s) const {
  const Drive& d = physics_.drive[axis];
  const double heat = d.gain_loss * (1 - std::exp(-time_s / d.gain_loss_s));
  const double input_v = command_v[axis] + d.crosstalk * command_v[1 - axis];
  return d.amplifier_gain * (1 - heat) * dead_zone(input_v, d.dead_zone_v) + d.offset_v;
}

double Crane::friction_level(std::size_t axis, double position, double speed, double time_s) const {
  const Drive& d = physics_.drive[axis];
  double level = d.coulomb_v[speed < 0 ? 1 : 0];
  if (d.stribeck_v > 0) level += d.stribeck_v * std::exp(-std::abs(speed) / d.stribeck_speed);
  if (d.bump_v > 0) {
    const double turn = 2 * std::numbers::pi * (position - d.bump_at) / d.bump_distance;
    level += d.bump_v * std::exp(1.5 * (std::cos(turn) - 1));
  }
  if (d.sticking_v > 0)
    for (const Span& span : dragging_)
      if (time_s >= span.from_s && time_s < span.to_s) level += d.sticking_v;
  return level;
}

/// What is left of the drive's input after friction and everything else that acts on the motor [V].
double Crane::drive_v(std::size_t axis, const Moving& at, double input_v, double time_s) const {
  const Drive& d = physics_.drive[axis];
  const std::size_t c = axis == 0 ? kMotorX : kMotorSlew;
  const double position = at.q[c], speed = at.rate[c];
  double v = d.lag_s > 0 ? at.lag_2[axis] : input_v;
  v -= drive_bristles_[axis].force(speed, friction_level(axis, position, speed, time_s));
  v -= d.viscous_vs[speed < 0 ? 1 : 0] * speed;
  v += along(within_tick(time_s), before_[axis], after_[axis]);
  if (d.ripple_v != 0) {
    const double turn = 2 * std::numbers::pi * position / d.ripple_distance + d.ripple_phase_rad;
    v += d.ripple_v * (std::sin(turn) + 0.25 * std::sin(2 * turn + 1));
  }
  if (d.detent_v != 0) {
    const double s = (position - d.detent_at) / d.detent_width;
    v -= d.detent_v * s * std::exp(0.5 * (1 - s * s));
  }
  if (d.hysteresis_v != 0) v -= d.hysteresis_v * at.hysteresis[axis];
  if (d.periodic_v != 0) v += d.periodic_v * std::sin(2 * std::numbers::pi * d.periodic_hz * time_s);
  return v;
}

/// Force from motor to carriage or jib through an elastic connection or a gap; a contact only pushes.
double Crane::connection(std::size_t axis, double apart, double parting) const {
  const Drive& d = physics_.drive[axis];
  const double driven = axis == 0 ? physics_.carriage_kg : 0.65 * physics_.jib_kgm2;
  const double stiffness = d.stiffness > 0 ? d.stiffness : kContactStiffness[axis];
  const double share = d.stiffness > 0 ? kElasticDamping : kContactDamping;
  const double damping = 2 * share * std::sqrt(stiffness * driven);
  if (d.gap <= 0) return stiffness * apart + damping * parting;
  if (apart > 0.5 * d.gap) return std::max(0.0, stiffness * (apart - 0.5 * d.gap) + damping * parting);
  if (apart < -0.5 * d.gap) return std::min(0.0, stiffness * (apart + 0.5 * d.gap) + damping * parting);
  return 0;
}

void Crane::add_connections(const Moving& at, Acting& acting) const {
  constexpr std::array<std::size_t, kDrives> kMotor{kMotorX, kMotorSlew}, kDriven{kCarriage, kJib};
  for (std::size_t i = 0; i < kDrives; ++i) {
    const std::size_t motor = kMotor[i], driven = kDriven[i];
    if (!mechanics_.moves(static_cast<Coordinate>(driven))) continue;
    const double force = connection(i, at.q[motor] - at.q[driven], at.rate[motor] - at.rate[driven]);
    acting.generalised[motor] -= force;
    acting.generalised[driven] += force;
    acting.generalised[driven] -= driven_bristles_[i].force(at.rate[driven], physics_.drive[i].gap_margin);
  }
}

/// Wind, gusts and drag on the load, in the jib's frame.
Vector Crane::load_force(const Moving& at, double time_s) const {
  const double share = within_tick(time_s), slew = at.q[mechanics_.of(kJib)];
  std::array<double, 6> noise;
  for (std::size_t i = 2; i < noise.size(); ++i) noise[i] = along(share, before_[i], after_[i]);
  const double gust = physics_.gust_mps > 0 ? noise[4] / physics_.gust_mps * physics_.gust_share : 0;
  const double wind = physics_.wind_n * (1 + gust);
  const double east = wind * std::cos(physics_.wind_towards_rad) + noise[2];
  const double north = wind * std::sin(physics_.wind_towards_rad) + noise[3];
  const double c = std::cos(slew), s = std::sin(slew);
  Vector force{c * east + s * north, -s * east + c * north, 0};
  if (physics_.load_periodic_n != 0)
    force[0] +=
        physics_.load_periodic_n * std::sin(2 * std::numbers::pi * physics_.load_periodic_hz * time_s);
  if (physics_.linear_drag_nspm == 0 && physics_.quadratic_drag == 0) return force;
  const Vector v = mechanics_.load(at.q, at.rate).velocity_mps;
  const Vector air{c * noise[4] + s * noise[5], -s * noise[4] + c * noise[5], 0};
  const Vector through{v[0] - air[0], v[1] - air[1], v[2] - air[2]};
  const double speed = std::hypot(through[0], through[1], through[2]);
  for (std::size_t i = 0; i < 3; ++i)
    force[i] -= (physics_.linear_drag_nspm + physics_.quadratic_drag * speed) * through[i];
  return force;
}

Crane::Moving Crane::slope(const Moving& at, const Volts& input_v, double time_s) const {
  Moving s;
  Acting acting;
  const std::array<double, kDrives> inertia{physics_.trolley_inertia_kg, physics_.jib_kgm2};
  for (std::size_t i = 0; i < kDrives; ++i) {
    const Drive& d = physics_.drive[i];
    if (!d.present) continue;
    const std::size_t c = i == 0 ? kMotorX : kMotorSlew;
    acting.generalised[c] = inertia[i] * d.gain * drive_v(i, at, input_v[i], time_s);
    if (d.lag_s > 0) {
      s.lag_1[i] = (input_v[i] - at.lag_1[i]) / (0.55 * d.lag_s);
      s.lag_2[i] = (at.lag_1[i] - at.lag_2[i]) / (0.45 * d.lag_s);
    }
    if (d.hysteresis_v != 0) {  // Bouc-Wen with n = 2, beta = gamma = 1/2
      const double h = at.hysteresis[i], v = at.rate[c];
      s.hysteresis[i] = v / d.hysteresis_distance * (1 - h * h * 0.5 * (1 + sign(v * h)));
    }
  }
  add_connections(at, acting);
  if (physics_.load_kg > 0) {
    acting.load_n = load_force(at, time_s);
    for (std::size_t i = 0; i < 2; ++i) {
      const std::size_t c = i == 0 ? kRadial : kTangential;
      acting.generalised[c] -= pivot_bristles_[i].force(at.rate[c], physics_.pivot_coulomb_nm) +
                               physics_.pivot_viscous * at.rate[c];
    }
  }
  if (mechanics_.moves(kCable)) {
    const double natural = physics_.cable_m + physics_.cable_error_m;
    const double damping =
        2 * kElasticDamping * std::sqrt(physics_.cable_stiffness_n / natural * physics_.load_kg);
    const double tension =
        physics_.cable_stiffness_n * (at.q[kCable] / natural - 1) + damping * at.rate[kCable];
    acting.generalised[kCable] -= std::max(0.0, tension);
  }
  s.q = at.rate;
  s.rate = mechanics_.accelerations(at.q, at.rate, acting);
  return s;
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

/// Strang splitting: half a step of the bristles, a whole one of the motion, half a step of the bristles.
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

/// Moments inside this tick at which a delayed command changes, and the tick's end.
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

void Crane::slip() {
  for (std::size_t i = 0; i < kDrives; ++i) {
    const double lost = physics_.drive[i].slip_per_s / kSlipsPerSecond * slips_.uniform(0.5, 1.5);
    if (slips_.uniform() < kSlipsPerSecond * kTick_s) slipped_[i] += lost;
  }
}

void Crane::remember() {
  if (physics_.swing_delay_s <= 0 && physics_.swing_average_s <= 0) return;
  past_.push_back({time_s_, now_.q[kRadial], now_.q[kTangential]});
  if (past_.size() > 20000)
    past_.erase(past_.begin(), std::lower_bound(past_.begin(), past_.end(), time_s_ - kHistory_s,
                                                [](const Past& p, double t) { return p.time_s < t; }));
}

std::array<double, 2> Crane::swing_at(double time_s) const {
  if (past_.empty()) return {now_.q[kRadial], now_.q[kTangential]};
  const auto next = std::lower_bound(past_.begin(), past_.end(), time_s,
                                     [](const Past& p, double t) { return p.time_s < t; });
  if (next == past_.begin()) return {next->radial_rad, next->tangential_rad};
  if (next == past_.end()) return {past_.back().radial_rad, past_.back().tangential_rad};
  const Past& before = *(next - 1);
  const double share = (time_s - before.time_s) / (next->time_s - before.time_s);
  return {along(share, before.radial_rad, next->radial_rad),
          along(share, before.tangential_rad, next->tangential_rad)};
}

Sensed Crane::sense() const {
  std::array<double, 2> swing{};
  if (physics_.swing_average_s > 0) {
    const int samples = std::max(1, static_cast<int>(std::lround(physics_.swing_average_s / 0.001)));
    for (int i = 0; i < samples; ++i) {
      const auto one = swing_at(time_s_ - physics_.swing_delay_s - 0.001 * i);
      for (std::size_t k = 0; k < 2; ++k) swing[k] += one[k] / samples;
    }
  } else {
    swing = swing_at(time_s_ - physics_.swing_delay_s);
  }
  if (physics_.swing_misalignment_rad != 0) {  // the direction of the cable in the sensor's turned frame
    const double c = std::cos(physics_.swing_misalignment_rad), s = std::sin(physics_.swing_misalignment_rad);
    const double ux = -std::cos(swing[1]) * std::sin(swing[0]), uy = std::sin(swing[1]);
    const double down = std::cos(swing[1]) * std::cos(swing[0]);
    swing = {std::atan2(-(c * ux + s * uy), down), std::asin(std::clamp(c * uy - s * ux, -1.0, 1.0))};
  }
  Sensed sensed{};
  sensed[0] = physics_.drive[0].encoder_scale * now_.q[kMotorX] + slipped_[0];
  sensed[1] = physics_.drive[1].encoder_scale * now_.q[kMotorSlew] + slipped_[1];
  for (std::size_t i = 0; i < 2; ++i)
    sensed[2 + i] = physics_.swing_scale[i] * swing[i] + physics_.swing_offset_rad[i];
  return sensed;
}

Sensed Crane::measure() {
  Sensed sensed = sense();
  const Sensed counts{physics_.trolley_counts_pm, physics_.slew_counts_prad, physics_.swing_counts_prad,
                      physics_.swing_counts_prad};
  for (std::size_t i = 0; i < sensed.size(); ++i) {
    const double noise = disturbance_.noise_counts * noise_.normal();
    if (counts[i] <= 0) continue;
    const double raw = sensed[i] * counts[i] + noise;
    sensed[i] = (disturbance_.quantised ? std::round(raw) : raw) / counts[i] + 0.0;  // no -0
  }
  return sensed;
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
