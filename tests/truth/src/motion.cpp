#include "motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "truth/truth.hpp"

namespace truth {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

double middle(const Physics& p, std::size_t axis) { return 0.5 * (p.low[axis] + p.high[axis]); }
double span(const Physics& p, std::size_t axis) { return p.high[axis] - p.low[axis]; }

/// Sines of about equal speed from 0.08 to 1.5 Hz, none near the natural frequency of the swing.
void add_sines(const Physics& p, Plan& plan, double size, Random& random) {
  const double swing_hz = std::sqrt(p.gravity_mps2 / plan.cable_m) / kTwoPi;
  for (std::size_t axis = 0; axis < kDrives; ++axis) {
    if (!p.drive[axis].present) continue;
    const double speed = (axis == 0 ? 0.11 : 0.2) * size * p.pace;
    for (const double around_hz : {0.08, 0.15, 0.28, 0.75, 1.1, 1.5}) {
      double hz = around_hz * random.uniform(0.88, 1.14);
      if (p.load_kg > 0 && std::abs(hz / swing_hz - 1) < 0.18) hz = swing_hz * 1.4;
      plan.reference[axis].sine(speed / (kTwoPi * hz), hz, random.uniform(0, kTwoPi));
    }
  }
}

void rich(const Physics& p, Plan& plan, double size, Random& random) {
  const Start& s = plan.start;
  plan.reference = {Reference{s.trolley_m}, Reference{s.slew_rad}};
  add_sines(p, plan, size, random);
}

/// Moves from point to point with pauses.
void moves(const Physics& p, Plan& plan, Random& random) {
  for (std::size_t axis = 0; axis < kDrives; ++axis) {
    if (!p.drive[axis].present) continue;
    const double fast = (axis == 0 ? 0.22 : 0.38) * p.pace * random.uniform(0.8, 1.1);
    double at_s = random.uniform(0.6, 1.4);
    while (at_s < plan.seconds) {
      double to = 0;
      do to = random.uniform(p.low[axis], p.high[axis]);
      while (std::abs(to - plan.reference[axis].end()) < 0.3 * span(p, axis));
      const double seconds = std::abs(to - plan.reference[axis].end()) / fast + 0.8;
      plan.reference[axis].move(at_s, to, seconds, 0.5 * seconds);
      at_s += seconds + random.uniform(0.8, 2.5);
    }
  }
}

/// Sweeps at constant low speeds in both directions.
void slow(const Physics& p, Plan& plan, Random& random) {
  for (std::size_t axis = 0; axis < kDrives; ++axis) {
    if (!p.drive[axis].present) continue;
    double at_s = 0.5, speed = (axis == 0 ? 0.012 : 0.03);
    double direction = random.sign();
    for (int i = 0; at_s < plan.seconds; ++i) {
      const double reach = std::min(speed * random.uniform(3.5, 5), 0.8 * span(p, axis));
      double to = plan.reference[axis].end() + direction * reach;
      to = std::clamp(to, p.low[axis], p.high[axis]);
      const double seconds = std::max(0.6, std::abs(to - plan.reference[axis].end()) / speed + 0.3);
      plan.reference[axis].move(at_s, to, seconds, 0.3);
      at_s += seconds + random.uniform(0.2, 0.8);
      direction = -direction;
      if (i % 2 == 1) speed = std::min(1.7 * speed, axis == 0 ? 0.25 : 0.5);
    }
  }
}

void half_turn(const Physics& p, Plan& plan, Random& random) {
  if (!p.drive[1].present) throw std::invalid_argument("run = slew_180: the rig has no slew drive");
  const double first = 0.2 * plan.seconds, seconds = 6.5;
  plan.start.slew_rad = -0.1;
  plan.reference[1] = Reference{plan.start.slew_rad};
  plan.reference[1].move(first, plan.start.slew_rad + std::numbers::pi, seconds, 2);
  if (plan.seconds > 24)
    plan.reference[1].move(0.6 * plan.seconds, plan.start.slew_rad + random.uniform(0, 0.4), seconds, 2);
  plan.reference[0].move(0.1 * plan.seconds, random.uniform(0.6, 0.9), 4, 1);
}

void release(const Physics& p, Plan& plan, double size, Random& random) {
  if (p.load_kg <= 0) throw std::invalid_argument("run = swing: the rig has no load");
  plan.swing_damping = 0;
  if (p.radial) plan.start.radial_rad = size * random.sign() * random.uniform(0.25, 0.38);
  const double most = p.kind == RigKind::pendulum ? 0.3 : 0.12;
  if (p.tangential) plan.start.tangential_rad = size * random.sign() * random.uniform(0.6, 1) * most;
}

double usual_seconds(std::string_view kind) {
  if (kind == "slow") return 50;
  if (kind == "rich" || kind == "moves") return 40;
  return 30;
}

}  // namespace

void Reference::move(double at_s, double position, double duration_s, double round_s) {
  moves_.push_back({at_s, end_, position, duration_s, std::min(round_s, 0.5 * duration_s)});
  end_ = position;
}

void Reference::sine(double amplitude, double frequency_hz, double phase_rad) {
  sines_.push_back({amplitude, kTwoPi * frequency_hz, phase_rad});
}

Target Reference::at(double time_s) const {
  Target t{start_, 0, 0};
  for (const Move& m : moves_) {
    if (time_s < m.at_s) break;
    if (time_s >= m.at_s + m.duration_s) {
      t = {m.to, 0, 0};
      continue;
    }
    // The speed rises as (1 - cos) / 2, is constant, and falls in the same form.
    const double into = time_s - m.at_s, left = m.duration_s - into;
    const double speed = (m.to - m.from) / (m.duration_s - m.round_s), omega = std::numbers::pi / m.round_s;
    const double edge = std::min(into, left), within = std::min(edge, m.round_s);
    const double covered =
        0.5 * speed * (within - std::sin(omega * within) / omega) + speed * (edge - within);
    t.position = into < left ? m.from + covered : m.to - covered;
    t.speed = 0.5 * speed * (1 - std::cos(omega * within));
    t.acceleration =
        edge < m.round_s ? 0.5 * speed * omega * std::sin(omega * within) * (into < left ? 1 : -1) : 0;
    break;
  }
  // The sines grow over two seconds and begin at rest, because their values at time 0 are subtracted with the
  // same weight.
  constexpr double kGrow_s = 2;
  const double share = std::min(time_s / kGrow_s, 1.0);
  const double w = share * share * (3 - 2 * share), dw = 6 * share * (1 - share) / kGrow_s;
  const double ddw = time_s < kGrow_s ? (6 - 12 * share) / (kGrow_s * kGrow_s) : 0;
  for (const Sine& s : sines_) {
    const double y = s.amplitude * std::sin(s.omega * time_s + s.phase);
    const double dy = s.amplitude * s.omega * std::cos(s.omega * time_s + s.phase);
    t.position += w * y;
    t.speed += w * dy + dw * y;
    t.acceleration += -w * s.omega * s.omega * y + 2 * dw * dy + ddw * y;
  }
  return t;
}

Plan plan(const Physics& p, std::string_view kind, double seconds, Random random) {
  const auto& kinds = run_kinds();
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw std::invalid_argument("run = " + std::string{kind} + ": not in the menu of runs");
  Plan plan;
  plan.seconds = seconds > 0 ? seconds : usual_seconds(kind);
  plan.cable_m = kind == "two_lengths" ? p.second_cable_m : p.cable_m;
  plan.start = {.trolley_m = middle(p, 0) + random.uniform(-0.05, 0.05) * span(p, 0),
                .slew_rad = middle(p, 1) + random.uniform(-0.1, 0.1) * span(p, 1)};
  plan.reference = {Reference{plan.start.trolley_m}, Reference{plan.start.slew_rad}};
  if (p.kind == RigKind::pendulum) {
    release(p, plan, kind == "large" ? 1.8 : kind == "small" ? 0.3 : 1, random);
    return plan;
  }
  if (kind == "rich" || kind == "two_lengths") rich(p, plan, 1, random);
  if (kind == "small") rich(p, plan, 0.4, random);
  if (kind == "large") rich(p, plan, 1.3, random);
  if (kind == "moves") moves(p, plan, random);
  if (kind == "slow") slow(p, plan, random);
  if (kind == "swing") release(p, plan, 1, random);
  if (kind == "slew_180") half_turn(p, plan, random);
  plan.break_away = kind == "rest_breakaway";
  return plan;
}

}  // namespace truth
